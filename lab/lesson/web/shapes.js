// Shapes of the scene: solids, arrows, ribbons on the ground, texts, and pictures to cover them. Metres; Z up.
import {make, write} from '#dom';
import {THREE} from 'three';

/** A picture, drawn with draw(pen), for a surface. */
export function makeTexture(width, height, draw) {
  const canvas = make('canvas', {width, height});
  draw(canvas.getContext('2d', {willReadFrequently: true}));
  const repeated = {wrapS: THREE.RepeatWrapping, wrapT: THREE.RepeatWrapping, anisotropy: 2};
  return Object.assign(new THREE.CanvasTexture(canvas), {colorSpace: THREE.SRGBColorSpace, ...repeated});
}

/** A body of one shape, with a shadow, at `place`, turned by `angles` about x, y, z. */
export function makeSolid(geometry, material, place = [0, 0, 0], angles = [0, 0, 0]) {
  const solid = new THREE.Mesh(geometry, new THREE.MeshPhongMaterial(material));
  solid.castShadow = true;
  solid.position.set(...place);
  solid.rotation.set(...angles);
  return solid;
}

/**
 * An arrow from the origin along +z, of length 1 until `pointArrow` is called; shaft radius in m; before: seen through
 * what is before it.
 */
export function makeArrow(radius, color, before = false) {
  const look = {color, depthTest: !before, transparent: before};
  const shaft = makeSolid(new THREE.CylinderGeometry(radius, radius, 1, 20).rotateX(Math.PI / 2), look);
  const head = makeSolid(new THREE.ConeGeometry(2.6 * radius, 7 * radius, 24).rotateX(Math.PI / 2), look);
  for (const part of before ? [shaft, head] : []) Object.assign(part, {renderOrder: 910, castShadow: false});
  return Object.assign(new THREE.Group().add(shaft, head), {userData: {shaft, head, headLength: 7 * radius}});
}

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
  arrow.quaternion.setFromUnitVectors(THREE.Object3D.DEFAULT_UP, vector.clone().divideScalar(length));
}

const SERIF = 'italic 600 $ Georgia, "Times New Roman", serif';

/** A flat band on the ground along points [[x, y], ...], in layers one over the other. */
export function makeRibbon(points, {width, height, layer, color, opacity}) {
  const [vertices, corners] = [[], []];
  let across = [0, 1];
  points.forEach(([x, y], i) => {
    const [a, b] = [points[i - 1] ?? points[i], points[i + 1] ?? points[i]];
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
    if (length > 1e-9) across = [-(b[1] - a[1]) / length, (b[0] - a[0]) / length];
    const [dx, dy] = across.map((part) => (part * width) / 2);
    vertices.push(x + dx, y + dy, height, x - dx, y - dy, height);
    if (i > 0) corners.push(...[-2, -1, 0, -1, 1, 0].map((k) => 2 * i + k));
  });
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(vertices, 3));
  geometry.setIndex(corners);
  const material =
      new THREE.MeshBasicMaterial({color, opacity, transparent: true, side: THREE.DoubleSide, depthWrite: false});
  return Object.assign(new THREE.Mesh(geometry, material), {frustumCulled: false, renderOrder: layer});
}

/** Shows a ribbon up to its row-th point. */
export const showRibbon = (ribbon, row) => ribbon.geometry.setDrawRange(0, 6 * Math.max(0, row));

/** A short text that always faces the reader, such as uphill or e_1 with its subscript; height, half its width in m. */
export function makeLabel(text, colour, height) {
  const width = Math.max(128, 40 * text.length);
  let length = 0;
  const map = makeTexture(width, 96, (pen) => {
    Object.assign(pen, {textBaseline: 'middle', fillStyle: colour});
    length = write(pen, text, 0, 48, 72, SERIF);
    pen.clearRect(0, 0, width, 96);
    write(pen, text, (width - length) / 2, 48, 72, SERIF);
  });
  const label = new THREE.Sprite(new THREE.SpriteMaterial({map, depthTest: false, transparent: true}));
  label.scale.set((height * width) / 96, height, 1);
  return Object.assign(label, {renderOrder: 5, userData: {half: height * length / 192}});
}

/** Frees what a group holds on the graphics card. */
export function dispose(group) {
  group.traverse(({geometry, material}) => [geometry, material?.map, material].forEach((held) => held?.dispose()));
}
