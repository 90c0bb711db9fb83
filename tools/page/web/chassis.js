// A car's body as a box: its centre X, Y, Z in m in fixed axes, and yaw, pitch, roll in rad (turned in this order about
// z, y, x; x forward, y to the left, z up).
import {dispose} from '#shapes';
import {THREE} from 'three';

export class ChassisModel {
  /** chassis: {name, size: [length, width, height] in m, table}. */
  constructor(chassis, look) {
    this.wheel = chassis;
    this.group = new THREE.Group();
    this.box = new THREE.Group();
    this.box.name = `body:${chassis.name}`;
    const shape = new THREE.BoxGeometry(...chassis.size);
    const skin = new THREE.MeshPhongMaterial({color: look.body, transparent: true, opacity: 0.45});
    const solid = new THREE.Mesh(shape, skin);
    solid.castShadow = true;
    const edges =
        new THREE.LineSegments(new THREE.EdgesGeometry(shape), new THREE.LineBasicMaterial({color: look.line}));
    const nose = new THREE.Mesh(
        new THREE.ConeGeometry(0.12 * chassis.size[1], 0.2 * chassis.size[1], 4),
        new THREE.MeshPhongMaterial({color: look.line}),
    );
    nose.rotation.z = -Math.PI / 2;
    nose.position.x = 0.5 * chassis.size[0] + 0.1 * chassis.size[1];
    this.box.add(solid, edges, nose);
    this.group.add(this.box);
  }

  update(t) {
    const at = (name) => this.wheel.table.value(name, t);
    this.box.position.set(at('X'), at('Y'), at('Z'));
    this.box.rotation.set(at('roll'), at('pitch'), at('yaw'), 'ZYX');
  }

  dispose() { dispose(this.group); }
}
