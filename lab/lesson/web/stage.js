// The 3-D stage: ground, light, cameras, and one or more views side by side in one canvas. Fixed axes X, Y, Z, Z up.
import {$, colour, fill} from '#dom';
import {dispose, makeTexture} from '#shapes';
import {OrbitControls, THREE} from 'three';

THREE.Object3D.DEFAULT_UP.set(0, 0, 1);
const GROUND = 60;  // squares along the edge of the drawn ground, at the least
const LENS = 34;    // degrees, from top to bottom
// Where the eye stands beside what it looks at, in sizes of the scene; but for `beside`, X is the heading.
const EYES = {
  beside: [1.5, -2.35, 1.0],
  behind: [-2.1, 1.7, 1.15],
  abreast: [0.3, -2.2, 0.55],
  above: [0.2, -2.3, 1.7]
};
const SUN = new THREE.Vector3(1.4, -1.1, 3.6);  // where it stands, in sizes of the scene

/** One square of the ground: lines about it and, finer, ten within it. */
function drawSquare(pen) {
  const lines = (name, width, places) =>
      places.forEach((place) => fill(pen, colour(name), [place, 0, width, 1024], [0, place, 1024, width]));
  fill(pen, colour('--ground'), [0, 0, 1024, 1024]);
  lines('--grid-fine', 3, [1, 2, 3, 4, 5, 6, 7, 8, 9].map((i) => 102.4 * i - 1.5));
  lines('--grid', 5, [0, 1019]);
}

export class Stage {
  /** size: m, how large the thing is that one looks at. */
  constructor(canvas, size) {
    Object.assign(this, {canvas, size, models: [], dirty: true});
    this.renderer = this.makeRenderer();
    this.scene = new THREE.Scene();
    this.scene.fog = new THREE.Fog('#fff', 4 * size, 14 * size);
    this.camera = new THREE.PerspectiveCamera(LENS, 1, 0.02 * size, 60 * size);
    this.eye = new THREE.PerspectiveCamera();
    this.controls = new OrbitControls(this.camera, canvas);
    Object.assign(this.controls, {maxPolarAngle: 1.54, minDistance: 0.8 * size, maxDistance: 12 * size});
    Object.assign(this.controls, {enableDamping: true, dampingFactor: 0.12, zoomSpeed: 0.8, keyRotateSpeed: 5});
    this.controls.addEventListener('change', () => (this.dirty = true));
    // Arrow keys turn the view; by themselves the controls do so with shift alone.
    const keys = (act) => (event) =>
        act({code: event.code, shiftKey: true, preventDefault: () => event.preventDefault()});
    this.controls.listenToKeyEvents({addEventListener: (kind, act) => canvas.addEventListener(kind, keys(act))});
    this.road = new THREE.Group();  // what is given in the road's axes: ground and wheels
    const surface = new THREE.MeshPhongMaterial({color: '#fff', shininess: 0, specular: '#000'});
    // Tracks lie 1 mm above: at a distance the rounding of depth is more.
    Object.assign(surface, {polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 4});
    this.ground = new THREE.Mesh(new THREE.PlaneGeometry(GROUND, GROUND), surface);
    this.ground.receiveShadow = true;
    this.road.add(this.ground);
    this.scene.add(this.road, new THREE.HemisphereLight('#ffffff', '#9aa3b2', 1.8));
    this.addSun();
    this.stand('beside');
    this.zoom(size);
  }

  /** The first view, of EYES. */
  stand(place) {
    if (this.place === place) return;
    this.place = place;
    this.camera.position.set(...EYES[place].map((part) => part * this.size));
    this.controls.update();
    this.controls.saveState();
  }

  /** What draws the scene, or null where there is no WebGL: all else of the page does without. */
  makeRenderer() {
    const {canvas} = this;
    canvas.addEventListener('webglcontextrestored', () => (this.dirty = true));
    try {
      const renderer = new THREE.WebGLRenderer({canvas, antialias: devicePixelRatio < 2});
      renderer.setPixelRatio(Math.min(2, devicePixelRatio));
      Object.assign(renderer.shadowMap, {enabled: true, type: THREE.PCFShadowMap});
      renderer.setScissorTest(true);
      return renderer;
    } catch {
      $('#blind').hidden = false;
      return null;
    }
  }

  /** Pixels of the picture to one of CSS. */
  get ratio() { return this.renderer?.getPixelRatio() ?? 1; }

  addSun() {
    this.sun = new THREE.DirectionalLight('#fff6e8', 2.3);
    this.sun.castShadow = true;
    Object.assign(this.sun.shadow, {radius: 4, bias: -0.0004, normalBias: 0.01});
    this.sun.shadow.mapSize.set(1024, 1024);
    const reach = 1.6 * this.size;
    Object.assign(this.sun.shadow.camera, {left: -reach, right: reach, top: reach, bottom: -reach});
    Object.assign(this.sun.shadow.camera, {near: 0.1 * this.size, far: 9 * this.size});
    this.scene.add(this.sun, this.sun.target);
  }

  /** Takes the colours of the theme. */
  dress() {
    this.scene.background = this.scene.fog.color = new THREE.Color(colour('--sky'));
    const {material} = this.ground;
    material.map?.dispose();
    Object.assign(material, {map: makeTexture(1024, 1024, drawSquare), needsUpdate: true});
    this.dirty = true;
  }

  /** Replaces the wheels: [WheelModel]. */
  put(models) {
    for (const {group} of this.models) dispose(group.removeFromParent());
    for (const {group} of models) this.road.add(group);
    Object.assign(this, {models, dirty: true});
  }

  /** Takes the canvas's size, and the views' rectangles {x, y, w, h} in CSS pixels from elements that lie over it. */
  resize(elements) {
    const [{x: left, y: top, width, height}, ...views] =
        [this.canvas, ...elements].map((element) => element.getBoundingClientRect());
    this.rectangles = views.map(({x, y, width: w, height: h}) => ({x: x - left, y: y - top, w, h}));
    if (this.renderer && !this.renderer.getSize(new THREE.Vector2()).equals({x: width, y: height}))
      this.renderer.setSize(width, height, false);
    this.dirty = true;
  }

  /** Shows bodies of another size, in m, as large as those of the first one. */
  zoom(size) {
    this.scale = this.size / size;
    this.road.scale.setScalar(this.scale);
    this.square = Math.min(1, 10 ** Math.floor(Math.log10(2 * size)));  // m, of the ground
  }

  /** Air and ground reach as far as an eye that is `away` times as far off can see. */
  widen(away) {
    const far = 14 * this.size * away;
    Object.assign(this.scene.fog, {near: 4 * this.size * away, far});
    const times = Math.ceil(far / (this.scale * this.square * (GROUND / 2)));
    this.ground.scale.set(times * this.square, times * this.square, 1);
    this.ground.material.map.repeat.set(GROUND * times, GROUND * times);
  }

  /**
   * Places the eye, `away` times as far off and turned by the heading, before a view of w by h pixels; on a slope it
   * stays above the road.
   */
  look(anchor, away, heading, w, h) {
    this.eye.copy(this.camera);
    // A narrow view needs a wider lens, or the wheel would leave it.
    Object.assign(this.eye, {far: 60 * this.size * away, aspect: w / h, fov: LENS * Math.min(1.7, Math.max(1, h / w))});
    this.eye.updateProjectionMatrix();
    const turn = new THREE.Quaternion().setFromAxisAngle(THREE.Object3D.DEFAULT_UP, heading);
    this.eye.position.multiplyScalar(away).applyQuaternion(turn).add(anchor);
    this.eye.quaternion.premultiply(turn);
    const normal = new THREE.Vector3(0, 0, 1).applyQuaternion(this.road.quaternion);
    const missing = 0.25 * this.size - this.eye.position.dot(normal);
    if (missing <= 0) return;
    this.eye.position.addScaledVector(normal, missing);
    this.eye.lookAt(anchor);
  }

  /**
   * Draws views [{models, anchor, up, heading}], vectors in the road's axes: each its own models about its own anchor,
   * all `away` times as far off, and the road turned so that `up`, the vertical, is the scene's Z.
   */
  render(views, away) {
    this.dirty = false;
    if (!this.renderer) return;
    this.widen(away);
    this.rectangles.forEach(({x, y, w, h}, i) => {
      const {models, anchor, up, heading} = views[i];
      for (const model of this.models) model.group.visible = models.includes(model);
      this.road.quaternion.setFromUnitVectors(up, THREE.Object3D.DEFAULT_UP);
      const there = anchor.clone().multiplyScalar(this.scale).applyQuaternion(this.road.quaternion);
      this.look(there, away, heading, w, h);
      this.sun.target.position.copy(there);
      this.sun.position.copy(there).addScaledVector(SUN, this.size);
      // Whole squares: the grid stands still.
      this.ground.position.copy(anchor).divideScalar(this.square).round().multiplyScalar(this.square).setZ(0);
      const place = [x, this.canvas.clientHeight - y - h, w, h];
      this.renderer.setViewport(...place);
      this.renderer.setScissor(...place);
      this.renderer.render(this.scene, this.eye);
    });
  }
}
