// A wheel in the scene, in the road's axes: a torus of ring radius r_0 and tube radius r in m, turned by psi about Z,
// theta about the line of nodes e1, and phi about the axle e3 (paper, (3)), with its contact path, carrier axes and the
// arrows of pictures.js.
import {colour, fill} from '#dom';
import {arrowsOf} from '#pictures';
import {dispose, makeArrow, makeLabel, makeRibbon, makeSolid, makeTexture, pointArrow, showRibbon} from '#shapes';
import {before, contactOf} from '#table';
import {THREE} from 'three';

const metal = (color, specular, shininess) => ({color, specular, shininess});
const [METAL, FACE] = [metal('#9aa2ac', '#6a7078', 40), metal('#8d949f', '#8a9098', 60)];
const GOLD = metal('#c2a04e', '#8d7a45', 60);
const UPRIGHT = [Math.PI / 2, 0, 0];  // a cylinder's axis along z
const COIN = 0.05;                    // m, up to which a disc is a coin
const {BoxGeometry, CylinderGeometry, TorusGeometry} = THREE;

/** The tyre's skin: tread on the outside, a stripe on each side wall, and the mark at phi = 0. x: along the ring. */
function drawTyre(pen, accent) {
  fill(pen, '#2b2e34', [0, 0, 2048, 256]);
  // The tube's angle runs down the picture: 0 and 256 the outside, 128 the inside.
  Object.assign(pen, {strokeStyle: '#191b1f', lineWidth: 5});
  for (let x = 0; x < 2048; x += 32) {
    for (const [from, to] of [[0, 46], [256, 210]]) {
      pen.moveTo(x, from);
      pen.lineTo(x + 14, to);
    }
  }
  pen.stroke();
  fill(pen, '#191b1f', ...[0, 22, 229, 252].map((y) => [0, y, 2048, 4]));
  fill(pen, accent, ...[74, 177].map((y) => [0, y, 2048, 5]), ...[0, 2008].map((x) => [x, 0, 40, 256]));
}

/** Tyre, and but for a hoop rim, spokes and hub, about the axle z; marked spoke and mark on the tyre at angle 0. */
function makeWheel(r_0, r, marked, hoop) {
  const map = makeTexture(2048, 256, (pen) => drawTyre(pen, marked.color));
  const ring = makeSolid(new TorusGeometry(r_0, r, 40, 180), {map, specular: '#26282c', shininess: 12});
  if (hoop) return [ring];
  const inner = r_0 - 0.72 * r;
  const middle = 0.5 * (inner + 0.1 * r_0);
  const spokes = [0, 1, 2, 3, 4].map((i) => {
    const shape = new BoxGeometry(inner - 0.1 * r_0, (i === 0 ? 0.2 : 0.13) * r_0, 0.55 * r);
    const angle = (2 * Math.PI * i) / 5;
    const place = [middle * Math.cos(angle), middle * Math.sin(angle), 0];
    return makeSolid(shape, i === 0 ? marked : METAL, place, [0, 0, angle]);
  });
  return [
    ring,
    makeSolid(new TorusGeometry(inner, 0.42 * r, 16, 120), METAL),
    makeSolid(new CylinderGeometry(0.2 * r_0, 0.2 * r_0, 1.1 * r, 48), METAL, [0, 0, 0], UPRIGHT),
    ...spokes,
  ];
}

/** A disc with a round edge and a marked radius at angle 0; a coin has a core of another metal. */
function makeDisc(r_0, r, marked, coin) {
  return [
    makeSolid(new CylinderGeometry(r_0, r_0, 2 * r, 160), FACE, [0, 0, 0], UPRIGHT),
    makeSolid(new BoxGeometry(0.995 * r_0, 0.16 * r_0, 2.2 * r), marked, [0.497 * r_0, 0, 0]),
    makeSolid(new TorusGeometry(r_0, r, 16, 160), METAL),
    ...(coin ? [makeSolid(new CylinderGeometry(0.7 * r_0, 0.7 * r_0, 2.1 * r, 120), GOLD, [0, 0, 0], UPRIGHT)] : []),
  ];
}

/** How a wheel is drawn: its moment about the axle tells a solid disc from a wheel, and a wheel from a bare hoop. */
export function lookOf({m, r_0, r, J_z, guided}) {
  const part = J_z / (m * (r_0 + r) ** 2);
  const disc = part < 0.55;
  const kind = disc ? (r_0 + r < COIN ? 'coin' : 'disc') : part > 0.9 ? 'hoop' : 'wheel';
  return {kind, r_0, r: Math.max(r, 0.012 * r_0), held: Boolean(guided)};
}

function makeBody({kind, r_0, r}, marked) {
  const solid = kind === 'disc' || kind === 'coin';
  return solid ? makeDisc(r_0, r, marked, kind === 'coin') : makeWheel(r_0, r, marked, kind === 'hoop');
}

/** The fork of a wheel carrier, upwards along e2 from the axle e3. */
function makeFork({r_0, r}) {
  const [half, top, thick] = [Math.max(1.8 * r, 0.14 * r_0), r_0 + 2.2 * Math.max(r, 0.1 * r_0), 0.06 * r_0];
  const look = {color: colour('--body')};
  return [
    makeSolid(new CylinderGeometry(thick / 2, thick / 2, 2 * half, 24), look, [0, 0, 0], UPRIGHT),
    ...[-half, half].map((z) => makeSolid(new BoxGeometry(thick, top, thick), look, [0, top / 2, z])),
    makeSolid(new BoxGeometry(1.5 * thick, thick, 2 * half + thick), look, [0, top, 0]),
    makeSolid(new CylinderGeometry(0.7 * thick, 0.7 * thick, 0.25 * r_0, 24), look, [0, top + 0.12 * r_0, 0]),
  ];
}

/** An arrow of the length of `vector` with a name beyond its tip. */
function makeNamed(name, vector, radius, height, colour, beyond) {
  const arrow = makeArrow(radius, colour);
  pointArrow(arrow, vector);
  const label = makeLabel(name, colour, height);
  label.position.copy(vector).multiplyScalar(beyond);
  return [arrow, label];
}

export class WheelModel {
  /** wheel: {name, parameters, colour, table, trace, phases}; size of the scene in m. */
  constructor(wheel, size) {
    const {name, parameters} = wheel;
    const look = lookOf(parameters);
    const {r_0, r} = parameters;
    const radius = r_0 + r;
    Object.assign(
        this, {wheel, look, size, r_0, r, group: new THREE.Group(), path: new THREE.Group(), axes: new THREE.Group()});
    const marked = {color: wheel.colour, specular: '#222', shininess: 15};
    this.body = new THREE.Group().add(...makeBody(look, marked));
    this.body.name = `spin:${name}`;
    for (const [i, length] of [1.5, 1.2, 1.125].entries()) {
      const along = new THREE.Vector3().setComponent(i, length * radius);
      this.axes.add(...makeNamed(
          `e_${i + 1}`, along, 0.022 * r_0, 0.3 * r_0, colour(`--e${i + 1}`), 1 + 0.12 / (length * radius)));
    }
    this.carrier = new THREE.Group().add(this.body, this.axes, ...(look.held ? makeFork(look) : []));
    this.arrows = new Map();
    this.ring = this.makeGhost();
    this.carrier.add(this.ring);
    const skin = {color: colour('--force'), transparent: true, side: THREE.DoubleSide, depthWrite: false};
    this.spot = new THREE.Mesh(new THREE.RingGeometry(0.07 * r_0, 0.11 * r_0, 40), new THREE.MeshBasicMaterial(skin));
    this.spot.renderOrder = 900;
    this.spot.position.z = 0.004 * size;
    const uphill =
        makeNamed('uphill', new THREE.Vector3(0.8 * radius, 0, 0), 0.03 * radius, 0.24 * radius, colour('--line'), 0.5);
    uphill.forEach((part, i) => part.position.add(new THREE.Vector3(1.2 * radius, 0, [0.03, 0.24][i] * radius)));
    this.uphill = new THREE.Group().add(...uphill);
    this.track = new THREE.Group();  // forward, left, up at the contact
    this.contact = new THREE.Group().add(this.spot, this.uphill, this.track);
    this.group.add(this.carrier, this.contact, this.path);
    this.drawPath();
  }

  /** A ring that shows how the wheel will have turned. */
  makeGhost() {
    const look = {color: colour('--momentum'), transparent: true, opacity: 0.35, depthWrite: false};
    return new THREE.Mesh(
        new TorusGeometry(this.r_0, 0.25 * Math.max(this.r, 0.08 * this.r_0), 12, 90),
        new THREE.MeshBasicMaterial(look));
  }

  /** The contact path anew: all of it faintly, up to now strongly, stick phases and skid marks; the way uphill. */
  drawPath() {
    const {wheel: {trace: {points}, table, phases, colour: accent, parameters}, size, r_0} = this;
    this.uphill.visible = parameters.slope > 0;
    this.uphill.rotation.z = parameters.slope_direction ?? 0;
    const unit = Math.max(0.045 * r_0, 0.006 * size);
    const ribbon = ([begin, end], color, width, layer, opacity) => {
      const first = this.point(begin);
      const part = points.slice(first, this.point(end) + 1);
      const look = {width: width * unit, height: 0.0005 * (1 + layer) * size, layer, color, opacity};
      return Object.assign(makeRibbon(part, look), {userData: {begin, first}});
    };
    const all = [table.start, table.end];
    const marks = (spans, name, width) => spans.map((span) => ribbon(span, colour(name), width, 2, 0.9));
    this.past =
        [ribbon(all, accent, 1, 3, 0.95), ...marks(phases.slides, '--slide', 4), ...marks(phases.sticks, '--stick', 5)];
    dispose(this.path);
    this.whole = ribbon(all, accent, 0.35, 1, 0.75);
    this.path.clear().add(this.whole, ...this.past);
  }

  /** The last point of the path at or before t. */
  point(t) { return Math.max(0, before(this.wheel.trace.times, t + 1e-9)); }

  /** Pose, path and arrows at t. show: {path, axes, future, pictures: [name], units: of unitsOf}. */
  update(t, show) {
    const {wheel: {table}, r_0, r} = this;
    const at = (name) => table.value(name, t);
    const [X, Y, psi, theta, phi] = ['X_O', 'Y_O', 'psi', 'theta', 'phi'].map(at);
    this.carrier.position.set(X, Y, table.has('Z_O') ? at('Z_O') : r_0 * Math.sin(theta) + r);
    this.carrier.rotation.set(theta, 0, psi, 'ZYX');
    this.body.rotation.z = phi;
    this.axes.visible = show.axes;
    this.path.visible = this.spot.visible = show.path;
    this.whole.visible = show.future;
    for (const ribbon of this.past) {
      ribbon.visible = t >= ribbon.userData.begin;
      showRibbon(ribbon, this.point(t) - ribbon.userData.first);
    }
    this.contact.position.set(...contactOf(r_0, X, Y, psi, theta), 0);
    this.track.rotation.z = psi;
    for (const {group} of this.arrows.values()) group.visible = false;
    this.ring.visible = false;
    for (const arrow of arrowsOf(this.wheel, show.pictures, t)) this.showArrow(arrow, show.units);
  }

  /** An arrow of pictures.js with its name at its tip; its length is in units of its kind, a length its own. */
  showArrow({name, kind, place, vector, from = [0, 0, 0], after = [0, 0, 0], color, faint = false}, units) {
    const scale = kind === 'length' ? 1 : (this.r_0 + this.r) / (units[kind]?.number ?? Infinity);
    const [length, tail] = [vector, after].map((parts) => new THREE.Vector3(...parts).multiplyScalar(scale));
    const {group, arrow, label} = this.arrows.get(name) ?? this.makeNamedArrow(name, place, color, faint);
    group.visible = true;
    group.position.set(...from).add(tail);
    pointArrow(arrow, length);
    label.visible = arrow.visible && !faint;
    label.position.copy(length).addScaledVector(length.clone().normalize(), 0.06 * this.r_0 + label.userData.half);
    if (!faint) return;
    this.ring.visible = arrow.visible;
    this.ring.quaternion.setFromUnitVectors(
        new THREE.Vector3(0, 0, Math.sign(vector[2]) || 1), length.clone().normalize());
  }

  makeNamedArrow(name, place, color, faint) {
    const arrow = makeArrow(0.028 * this.r_0, colour(color), true);
    if (faint) arrow.traverse(({material}) => material && Object.assign(material, {opacity: 0.45}));
    const label = makeLabel(name, colour(color), 0.3 * this.r_0);
    const group = new THREE.Group().add(arrow, label);
    (place === 'centre' ? this.carrier : this.track).add(group);
    this.arrows.set(name, {group, arrow, label});
    return this.arrows.get(name);
  }
}
