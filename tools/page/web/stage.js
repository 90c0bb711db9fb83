// The 3-D stage: ground, light, cameras, and one or more views side by side in one canvas. Fixed axes X, Y, Z, Z up.
import {colour} from '#theme';
import {OrbitControls, THREE} from 'three';

THREE.Object3D.DEFAULT_UP.set(0, 0, 1);
const GROUND = 60;  // squares along the edge of the drawn ground, at the least

/** One square of the ground: lines about it and, finer, ten within it. */
function groundTexture(base, fine, coarse) {
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = 1024;
  const pen = canvas.getContext('2d', {willReadFrequently: true});
  pen.fillStyle = base;
  pen.fillRect(0, 0, 1024, 1024);
  pen.fillStyle = fine;
  for (let i = 1; i < 10; ++i) {
    pen.fillRect(102.4 * i - 1.5, 0, 3, 1024);
    pen.fillRect(0, 102.4 * i - 1.5, 1024, 3);
  }
  pen.fillStyle = coarse;
  for (const edge of [0, 1019]) {
    pen.fillRect(edge, 0, 5, 1024);
    pen.fillRect(0, edge, 1024, 5);
  }
  const texture = new THREE.CanvasTexture(canvas);
  texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
  texture.repeat.set(GROUND, GROUND);
  texture.colorSpace = THREE.SRGBColorSpace;
  return texture;
}

export class Stage {
  /** size: m, how large the thing is that one looks at. */
  constructor(canvas, size) {
    this.canvas = canvas;
    this.size = size;
    this.renderer = new THREE.WebGLRenderer({canvas, antialias: devicePixelRatio < 2});
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = THREE.PCFShadowMap;
    this.scene = new THREE.Scene();
    this.road = new THREE.Group();  // what is given in the road's axes: ground and bodies
    this.scene.add(this.road);
    this.scene.fog = new THREE.Fog('#fff', 4 * size, 14 * size);
    this.camera = new THREE.PerspectiveCamera(34, 1, 0.02 * size, 60 * size);
    this.camera.position.set(1.5 * size, -2.35 * size, 1.0 * size);
    this.controls = new OrbitControls(this.camera, canvas);
    Object.assign(this.controls, {maxPolarAngle: 1.54, minDistance: 0.8 * size, maxDistance: 12 * size});
    Object.assign(this.controls, {enableDamping: true, dampingFactor: 0.12, zoomSpeed: 0.8});
    canvas.addEventListener('keydown', (event) => {
      const way = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key];
      if (way) this.turn(0.09 * way[0], 0.06 * way[1]);
    });
    this.controls.addEventListener('change', () => (this.dirty = true));
    this.eye = new THREE.PerspectiveCamera();
    this.addGround();
    this.addLight();
    this.dirty = true;
    this.models = [];
    this.zoom(size);
  }

  addGround() {
    const plane = new THREE.PlaneGeometry(GROUND, GROUND);
    this.ground = new THREE.Mesh(plane, new THREE.MeshPhongMaterial({color: '#fff', shininess: 0, specular: '#000'}));
    this.ground.receiveShadow = true;
    this.road.add(this.ground);
  }

  addLight() {
    this.sky = new THREE.HemisphereLight('#ffffff', '#9aa3b2', 1.8);
    this.sky.position.set(0, 0, 1);
    this.sun = new THREE.DirectionalLight('#fff6e8', 2.3);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(1024, 1024);
    this.sun.shadow.radius = 4;
    this.sun.shadow.bias = -0.0004;
    this.sun.shadow.normalBias = 0.01;
    const reach = 1.6 * this.size;
    Object.assign(this.sun.shadow.camera, {left: -reach, right: reach, top: reach, bottom: -reach});
    Object.assign(this.sun.shadow.camera, {near: 0.1 * this.size, far: 9 * this.size});
    this.scene.add(this.sky, this.sun, this.sun.target);
  }

  /** Takes the colours of the theme. */
  dress() {
    const air = new THREE.Color(colour('--sky'));
    this.scene.background = air;
    this.scene.fog.color = air;
    this.ground.material.map?.dispose();
    this.ground.material.map = groundTexture(colour('--ground'), colour('--grid-fine'), colour('--grid'));
    this.ground.material.map.anisotropy = 2;
    this.ground.material.needsUpdate = true;
    this.dirty = true;
  }

  /** Replaces the bodies: [WheelModel or ChassisModel]. */
  put(models) {
    for (const old of this.models) {
      this.road.remove(old.group);
      old.dispose();
    }
    this.models = models;
    for (const model of models) this.road.add(model.group);
    this.dirty = true;
  }

  /** The views' rectangles in CSS pixels: beside each other, above each other where the canvas is tall. */
  rectangles(count) {
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight];
    const across = width >= 0.9 * height ? count : 1;
    const down = across === 1 ? count : 1;
    const [w, h] = [width / across, height / down];
    return Array.from({length: count}, (_, i) => ({x: (i % across) * w, y: across === 1 ? i * h : 0, w, h}));
  }

  resize() {
    const {clientWidth, clientHeight} = this.canvas;
    const size = this.renderer.getSize(new THREE.Vector2());
    if (size.x === clientWidth && size.y === clientHeight) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.dirty = true;
  }

  /**
   * Turns the road so that `up`, the vertical in the road's axes, is the scene's Z; returns the anchor there.
   */
  tilt(up, anchor) {
    this.road.quaternion.setFromUnitVectors(up, THREE.Object3D.DEFAULT_UP);
    return anchor.clone().multiplyScalar(this.scale).applyQuaternion(this.road.quaternion);
  }

  /** Shows bodies of another size, in m, as large as those of the first one. */
  zoom(size) {
    this.scale = this.size / size;
    this.road.scale.setScalar(this.scale);
    this.square = Math.min(1, 10 ** Math.floor(Math.log10(2 * size)));  // m, of the ground
  }

  /** Air and ground reach as far as an eye that is `away` times as far off can see. */
  widen(away) {
    Object.assign(this.scene.fog, {near: 4 * this.size * away, far: 14 * this.size * away});
    const times = Math.ceil((14 * this.size * away) / (this.scale * this.square * (GROUND / 2)));
    this.ground.scale.set(times * this.square, times * this.square, 1);
    this.ground.material.map.repeat.set(GROUND * times, GROUND * times);
    this.reach = 60 * this.size * away;
  }

  /** Places the eye; on a slope it stays above the road. */
  look(anchor, away) {
    this.eye.copy(this.camera);
    this.eye.far = this.reach;
    this.eye.position.multiplyScalar(away).add(anchor);
    const normal = new THREE.Vector3(0, 0, 1).applyQuaternion(this.road.quaternion);
    const missing = 0.25 * this.size - this.eye.position.dot(normal);
    if (missing <= 0) return;
    this.eye.position.addScaledVector(normal, missing);
    this.eye.lookAt(anchor);
  }

  /**
   * Draws views [{models, anchor, up}], vectors in the road's axes: each its own models about its own anchor, all
   * `away` times as far off.
   */
  render(views, away) {
    this.controls.update();
    this.widen(away);
    this.renderer.setScissorTest(true);
    this.rectangles(views.length).forEach(({x, y, w, h}, i) => {
      const {models, anchor: there, up: vertical} = views[i];
      for (const model of this.models) model.group.visible = models.includes(model);
      const anchor = this.tilt(vertical, there);
      this.look(anchor, away);
      // A narrow view needs a wider lens, or the wheel would leave it.
      this.eye.fov = w < h ? 34 * Math.min(1.7, h / w) : 34;
      this.eye.aspect = w / h;
      this.eye.updateProjectionMatrix();
      this.sun.target.position.copy(anchor);
      this.sun.position.copy(this.sun.target.position);
      this.sun.position.x += 1.4 * this.size;
      this.sun.position.y -= 1.1 * this.size;
      this.sun.position.z += 3.6 * this.size;
      // Whole squares: the grid stands still.
      this.ground.position.copy(there).divideScalar(this.square).round().multiplyScalar(this.square).setZ(0);
      const up = this.canvas.clientHeight - y - h;
      this.renderer.setViewport(x, up, w, h);
      this.renderer.setScissor(x, up, w, h);
      this.renderer.render(this.scene, this.eye);
    });
    this.dirty = false;
  }

  /** Turns the view about the vertical and up or down, in rad. */
  turn(around, over) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const flat = Math.hypot(offset.x, offset.y);
    const azimuth = Math.atan2(offset.y, offset.x) + around;
    const polar = Math.min(1.5, Math.max(0.12, Math.atan2(flat, offset.z) + over));  // from the vertical
    const length = offset.length();
    offset.set(Math.cos(azimuth) * Math.sin(polar), Math.sin(azimuth) * Math.sin(polar), Math.cos(polar));
    this.camera.position.copy(this.controls.target).addScaledVector(offset, length);
    this.dirty = true;
  }

  /** The first camera again. */
  home() {
    this.controls.reset();
    this.dirty = true;
  }
}
