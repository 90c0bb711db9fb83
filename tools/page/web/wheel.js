// One wheel in the scene: a torus of ring radius r_0 and tube radius r in m, turned by psi about Z, theta about the
// line of nodes e1, and phi about the axle e3 (paper, (3)); its contact path, carrier axes and the ground's force.
import {dispose, makeArrow, makeLabel, makeRibbon, pointArrow, showRibbon, tyreTexture} from '#shapes';
import {before, contactOf} from '#table';
import {THREE} from 'three';

const METAL = {
  color: '#9aa2ac',
  specular: '#6a7078',
  shininess: 40
};
const UP = new THREE.Vector3(0, 0, 1);
const NODES = new THREE.Vector3(1, 0, 0);
const FORCE = ['lambda_1', 'lambda_2', 'lambda_3'];  // of the ground, fixed axes
const turn = new THREE.Quaternion();

/** A group, and a function that adds a body of this shape to it. */
function workshop() {
  const body = new THREE.Group();
  const add = (geometry, material) => {
    const mesh = new THREE.Mesh(geometry, material);
    mesh.castShadow = true;
    body.add(mesh);
    return mesh;
  };
  return {body, add};
}

/** Tyre, rim, spokes and hub about the axle z; marked spoke and mark on the tyre at angle 0. */
function makeBody(r_0, r, accent) {
  const {body, add} = workshop();
  const metal = new THREE.MeshPhongMaterial(METAL);
  add(new THREE.TorusGeometry(r_0, r, 40, 180),
      new THREE.MeshPhongMaterial({map: tyreTexture(accent), specular: '#26282c', shininess: 12}));
  const inner = r_0 - 0.72 * r;
  add(new THREE.TorusGeometry(inner, 0.42 * r, 16, 120), metal);
  add(new THREE.CylinderGeometry(0.2 * r_0, 0.2 * r_0, 1.1 * r, 48), metal).rotation.x = Math.PI / 2;
  const marked = new THREE.MeshPhongMaterial({color: accent, specular: '#222', shininess: 15});
  for (let i = 0; i < 5; ++i) {
    const width = (i === 0 ? 0.2 : 0.13) * r_0;
    const spoke = add(new THREE.BoxGeometry(inner - 0.1 * r_0, width, 0.55 * r), i === 0 ? marked : metal);
    const angle = (2 * Math.PI * i) / 5;
    const middle = 0.5 * (inner + 0.1 * r_0);
    spoke.position.set(middle * Math.cos(angle), middle * Math.sin(angle), 0);
    spoke.rotation.z = angle;
  }
  return body;
}

/** The thin disc, r = 0, with a marked radius at angle 0; it is drawn as thick as a coin. */
function makeDisc(r_0, accent) {
  const {body, add} = workshop();
  const thickness = 0.024 * r_0;
  const face = new THREE.MeshPhongMaterial({color: '#8d949f', specular: '#8a9098', shininess: 60});
  add(new THREE.CylinderGeometry(r_0, r_0, thickness, 160), face).rotation.x = Math.PI / 2;
  const marked = new THREE.MeshPhongMaterial({color: accent, specular: '#222', shininess: 15});
  add(new THREE.BoxGeometry(0.995 * r_0, 0.16 * r_0, 1.3 * thickness), marked).position.x = 0.497 * r_0;
  add(new THREE.TorusGeometry(r_0, 0.5 * thickness, 12, 160), new THREE.MeshPhongMaterial(METAL));
  return body;
}

/** e1, e2, e3 as arrows from O, with names. */
function makeAxes(r_0, r, colours) {
  const axes = new THREE.Group();
  const reach = 1.5 * (r_0 + r);
  const directions = [new THREE.Vector3(1, 0, 0), new THREE.Vector3(0, 1, 0), new THREE.Vector3(0, 0, 0.75)];
  directions.forEach((direction, i) => {
    const arrow = makeArrow(0.022 * r_0, colours[i]);
    pointArrow(arrow, direction.multiplyScalar(reach));
    const label = makeLabel(`e_${i + 1}`, colours[i], 0.3 * r_0);
    label.position.copy(direction).multiplyScalar(1 + 0.12 / direction.length());
    axes.add(arrow, label);
  });
  return axes;
}

/** An arrow on the ground along x, to be turned uphill, with its name. */
function makeUphill(size, colour) {
  const group = new THREE.Group();
  const arrow = makeArrow(0.03 * size, colour);
  pointArrow(arrow, new THREE.Vector3(0.8 * size, 0, 0));
  arrow.position.z = 0.03 * size;
  const label = makeLabel('uphill', colour, 0.24 * size);
  label.position.set(0.4 * size, 0, 0.24 * size);
  group.add(arrow, label);
  return group;
}

export class WheelModel {
  /**
   * wheel: {name, r_0, r, slope?, slope_direction?, table, trace, phases}; look: CSS colours {accent, stick, force,
   * line, axes: [3]}, size of the scene in m.
   */
  constructor(wheel, look) {
    this.wheel = wheel;
    this.look = look;
    this.group = new THREE.Group();
    this.carrier = new THREE.Group();
    this.carrier.name = `wheel:${wheel.name}`;
    this.body =
        wheel.r > 0.01 * wheel.r_0 ? makeBody(wheel.r_0, wheel.r, look.accent) : makeDisc(wheel.r_0, look.accent);
    this.body.name = `spin:${wheel.name}`;
    this.axes = makeAxes(wheel.r_0, wheel.r, look.axes);
    this.carrier.add(this.body, this.axes);
    this.force = makeArrow(0.03 * wheel.r_0, look.force);
    const ring = new THREE.RingGeometry(0.07 * wheel.r_0, 0.11 * wheel.r_0, 40);
    this.spot = new THREE.Mesh(
        ring,
        new THREE.MeshBasicMaterial({color: look.force, transparent: true, side: THREE.DoubleSide, depthWrite: false}));
    this.spot.renderOrder = 900;
    this.uphill = makeUphill(wheel.r_0 + wheel.r, look.line);
    this.group.add(this.carrier, this.force, this.spot, this.uphill);
    this.drawPath();
    const N = wheel.table.columns.lambda_3;
    this.weight = N ? N.reduce((sum, value) => sum + value, 0) / N.length : 0;
  }

  /** The contact path anew: all of it faintly, up to now strongly, stick phases in a colour of their own. */
  drawPath() {
    for (const old of [this.whole, this.past, ...(this.held ?? [])])
      if (old) this.group.remove(old);
    const {trace: {points}, r_0, phases} = this.wheel;
    const flat = (colour, opacity) => new THREE.MeshBasicMaterial(
        {color: colour, transparent: true, opacity, side: THREE.DoubleSide, depthWrite: false});
    const width = Math.max(0.045 * r_0, 0.006 * this.look.size);
    this.whole = makeRibbon(points, 0.5 * width, 0.001 * this.look.size, flat(this.look.accent, 0.3));
    this.past = makeRibbon(points, width, 0.002 * this.look.size, flat(this.look.accent, 0.95));
    this.held = phases.sticks.map(([begin, end]) => {
      const first = this.point(begin);
      const some = points.slice(first, this.point(end) + 1);
      const ribbon = makeRibbon(some, 5 * width, 0.0015 * this.look.size, flat(this.look.stick, 0.9));
      ribbon.userData = {begin, first};
      return ribbon;
    });
    this.group.add(this.whole, this.past, ...this.held);
    [this.whole, ...this.held, this.past].forEach((ribbon, i) => (ribbon.renderOrder = 1 + i));
  }

  /** The last point of the path at or before t. */
  point(t) { return Math.max(0, before(this.wheel.trace.times, t + 1e-9)); }

  /** Pose, path and force at t. show: {path, axes, force}. */
  update(t, show) {
    const {table, r_0, r, slope = 0, slope_direction: direction = 0} = this.wheel;
    const at = (name) => table.value(name, t);
    const [X, Y, psi, theta, phi] = ['X_O', 'Y_O', 'psi', 'theta', 'phi'].map(at);
    this.carrier.position.set(X, Y, table.has('Z_O') ? at('Z_O') : r_0 * Math.sin(theta) + r);
    this.carrier.quaternion.setFromAxisAngle(UP, psi).multiply(turn.setFromAxisAngle(NODES, theta));
    this.body.rotation.z = phi;
    this.axes.visible = show.axes;
    const now = this.point(t);
    for (const ribbon of [this.whole, this.past, ...this.held]) ribbon.visible = show.path;
    showRibbon(this.past, now);
    for (const ribbon of this.held) {
      ribbon.visible &&= t >= ribbon.userData.begin;
      showRibbon(ribbon, now - ribbon.userData.first);
    }
    const contact = contactOf(r_0, X, Y, psi, theta);
    this.spot.visible = show.path;
    this.spot.position.set(...contact, 0.004 * this.look.size);
    this.uphill.visible = slope > 0;
    const reach = 1.2 * (r_0 + r);
    this.uphill.rotation.z = direction;
    this.uphill.position.set(contact[0] + reach * Math.cos(direction), contact[1] + reach * Math.sin(direction), 0);
    this.force.visible = show.force && FORCE.every((name) => table.has(name));
    if (this.force.visible) {
      const scale = (1.1 * (r_0 + r)) / (this.weight || 1);
      this.force.position.set(...contact, 0);
      pointArrow(this.force, new THREE.Vector3(...FORCE.map(at)).multiplyScalar(scale));
    }
  }

  dispose() { dispose(this.group); }
}
