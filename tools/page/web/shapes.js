// Shapes of the scene: tyre, arrows, ribbons on the ground, labels. Metres; Z up.
import {THREE} from 'three';

/** The tyre's skin: tread on the outside, a stripe on each side wall, and the mark at phi = 0. x: along the ring. */
export function tyreTexture(accent) {
  const canvas = document.createElement('canvas');
  [canvas.width, canvas.height] = [2048, 256];
  const pen = canvas.getContext('2d', {willReadFrequently: true});
  pen.fillStyle = '#2b2e34';
  pen.fillRect(0, 0, 2048, 256);
  // The tube's angle runs down the picture: 0 and 256 the outside, 128 the inside.
  pen.strokeStyle = '#191b1f';
  pen.lineWidth = 5;
  for (let x = 0; x < 2048; x += 32) {
    for (const [from, to] of [[0, 46], [256, 210]]) {
      pen.beginPath();
      pen.moveTo(x, from);
      pen.lineTo(x + 14, to);
      pen.stroke();
    }
  }
  pen.fillStyle = '#191b1f';
  for (const y of [0, 22, 229, 252]) pen.fillRect(0, y, 2048, 4);
  pen.fillStyle = accent;
  for (const y of [74, 177]) pen.fillRect(0, y, 2048, 5);
  for (const x of [0, 2048 - 40]) pen.fillRect(x, 0, 40, 256);
  const texture = new THREE.CanvasTexture(canvas);
  texture.colorSpace = THREE.SRGBColorSpace;
  texture.wrapS = THREE.RepeatWrapping;
  texture.anisotropy = 2;
  return texture;
}

/** An arrow from the origin along +z, of length 1 until `pointArrow` is called; shaft radius in m. */
export function makeArrow(radius, colour) {
  const material = new THREE.MeshPhongMaterial({color: colour});
  const shaft = new THREE.Mesh(new THREE.CylinderGeometry(radius, radius, 1, 20), material);
  const head = new THREE.Mesh(new THREE.ConeGeometry(2.6 * radius, 7 * radius, 24), material);
  for (const part of [shaft, head]) {
    part.geometry.rotateX(Math.PI / 2);
    part.castShadow = true;
  }
  const arrow = new THREE.Group();
  arrow.add(shaft, head);
  arrow.userData = {shaft, head, headLength: 7 * radius};
  return arrow;
}

const ALONG = new THREE.Vector3(0, 0, 1);

/** Points an arrow of makeArrow along a vector whose length is that of the arrow in m. */
export function pointArrow(arrow, vector) {
  const {shaft, head, headLength} = arrow.userData;
  const length = vector.length();
  arrow.visible = length > 1e-6;
  if (!arrow.visible) return;
  const cone = Math.min(headLength, 0.6 * length);
  shaft.scale.z = length - cone;
  shaft.position.z = (length - cone) / 2;
  head.scale.setScalar(cone / headLength);
  head.position.z = length - cone / 2;
  arrow.quaternion.setFromUnitVectors(ALONG, vector.clone().divideScalar(length));
}

/** A flat band on the ground along points [[x, y], ...]; its first n points are shown by `showRibbon`. */
export function makeRibbon(points, width, height, material) {
  const n = points.length;
  const vertices = new Float32Array(6 * n);
  let [nx, ny] = [0, 1];
  for (let i = 0; i < n; ++i) {
    const a = points[Math.max(0, i - 1)];
    const b = points[Math.min(n - 1, i + 1)];
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
    if (length > 1e-9) [nx, ny] = [-(b[1] - a[1]) / length, (b[0] - a[0]) / length];
    const [dx, dy] = [(nx * width) / 2, (ny * width) / 2];
    vertices.set([points[i][0] + dx, points[i][1] + dy, height, points[i][0] - dx, points[i][1] - dy, height], 6 * i);
  }
  const order = [];
  for (let i = 0; i + 1 < n; ++i) order.push(2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 1, 2 * i + 3, 2 * i + 2);
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(vertices, 3));
  geometry.setIndex(order);
  const ribbon = new THREE.Mesh(geometry, material);
  ribbon.frustumCulled = false;
  return ribbon;
}

/** Shows a ribbon up to its row-th point. */
export function showRibbon(ribbon, row) { ribbon.geometry.setDrawRange(0, 6 * Math.max(0, row)); }

/** A short text that always faces the reader, such as uphill or e_1 with its subscript; height in m. */
export function makeLabel(text, colour, height) {
  const canvas = document.createElement('canvas');
  const [name, low = ''] = text.split('_');
  [canvas.width, canvas.height] = [Math.max(128, 40 * name.length), 96];
  const pen = canvas.getContext('2d', {willReadFrequently: true});
  Object.assign(pen, {textBaseline: 'middle', textAlign: 'center', fillStyle: colour});
  pen.font = 'italic 600 72px Georgia, "Times New Roman", serif';
  pen.fillText(name, canvas.width / 2 - 14 * low.length, 48, canvas.width);
  pen.font = '600 46px Georgia, "Times New Roman", serif';
  pen.fillText(low, 86, 64);
  const texture = new THREE.CanvasTexture(canvas);
  texture.colorSpace = THREE.SRGBColorSpace;
  const label = new THREE.Sprite(new THREE.SpriteMaterial({map: texture, depthTest: false, transparent: true}));
  label.scale.set((height * canvas.width) / canvas.height, height, 1);
  label.renderOrder = 5;
  return label;
}

/** Frees what a group holds on the graphics card. */
export function dispose(group) {
  group.traverse((node) => {
    node.geometry?.dispose();
    node.material?.map?.dispose();
    node.material?.dispose();
  });
}
