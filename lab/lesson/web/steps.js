// The steps of the lesson (docs/physics.md). Each has its picture, its one or two diagrams, its one to three controls,
// and a text that takes every figure from the motion of the step's own start. wheel: {table, phases, parameters};
// other: the one beside it.
import {DEGREES, live} from '#dom';
import {contact, criticalSpin, GHOST} from '#pictures';
import {extent} from '#table';

const MEASURE = 20;  // degrees of lean, from which on a wheel counts as one that does not stay up
const PAPER = {
  lean: 15,
  spin: 2
};

/** A symbol in the colour of its arrow. */
const arrow = (symbol, own) => `<b style="color:var(--${own})">${symbol}</b>`;
const [L, M, dL, N] = [['L', 'momentum'], ['M', 'tips'], ['dL', 'tips'], ['N', 'force']].map((one) => arrow(...one));
const [V, TURN, SLIP] = [['v', 'v'], ['R ω<sub>z</sub>', 'turn'], ['slip', 'slide']].map((one) => arrow(...one));

const leansOf = ({table}) => table.columns.theta.map((theta) => Math.abs(90 - DEGREES * theta));
/** The largest lean of a motion, in degrees. */
const lean = (wheel) => extent(leansOf(wheel))[1].toFixed(1);
/** The first instant, s, of a lean of so many degrees. */
const leans = (wheel, angle) => wheel.table.time[leansOf(wheel).findIndex((one) => one > angle)].toFixed(1);
const at = ({table}, t) => (name) => table.value(name, t);
const joules = (wheel, t) => at(wheel, t)('E').toFixed(1);
const spin = (wheel, t = 0) => Math.abs(at(wheel, t)('omega_z'));
/** By how much a quantity changes while friction holds the wheel for the first time. */
const whileHeld = ({table, phases: {sticks: [[begin, end]]}}, name) =>
    Math.abs(table.value(name, end) - table.value(name, begin));

/** Picture and diagrams of free play, by the picture's name. */
export const FREE = {
  precession: {label: 'precession', diagrams: ['lean', 'bars']},
  resistance: {label: 'resistance', diagrams: ['spin', 'hold']},
  sliding: {label: 'sliding', diagrams: ['speeds', 'circle']},
};

/** Of a wheel in a fork, in the place of precession: the moment of the fork. */
export const FORK = {
  name: 'carrier',
  diagrams: ['path', 'carrier']
};

/**
 * A step: start: what is chosen at first, and what else belongs to its run (controls.js); beside: what differs for a
 * second wheel, of names; controls: that the reader has, `push` the buttons at the clock; at, speed: of the clock; ask:
 * {text, until: s at which the motion has answered, fates, right(wheel, other): the number of the true one}; without
 * fates the reader draws the lean over time.
 */
export function stepsOf() {
  const paper = live.bodies.tyre.parameters;
  const {m, g, r_0, r} = paper;
  const limit = criticalSpin(paper);
  const [slower, faster] = [0.9, 1.1].map((part) => Number((part * limit).toFixed(3)));
  return [
    {
      title: 'It rolls. And then?',
      start: {lean: 0.5, spin: slower},
      controls: ['push', 'spin'],
      diagrams: ['lean'],
      text: (wheel) => `A wheel of ${m} kg, shaped as a torus, touches the road at one point and does not slide there.
        So its spin of ${spin(wheel).toFixed(2)} rad/s times its radius of ${(r_0 + r).toFixed(2)} m is its speed,
        ${Math.abs(at(wheel, 0)('v_x')).toFixed(2)} m/s. Half a degree of lean is enough: at ${leans(wheel, 5)} s it
        leans by 5°, and goes on to ${lean(wheel)}°. Not every wheel does. The next steps show why.`,
      attempt: 'At the start, hold <b>push forward ▶</b> for a second: it stays up.',
    },
    {
      title: 'Why it does not fall',
      start: {lean: 15, spin: 6},
      controls: ['spin'],
      picture: 'precession',
      diagrams: ['lean', 'path'],
      eye: 'behind',
      text: (wheel) => `The weight tips the wheel: about the contact, its moment ${M} points along e<sub>1</sub>. The
        rolling wheel has an angular momentum ${L} along its axle. M acts across L, so it does not make L longer: it
        adds ${dL} at its tip and turns it, and with it the axle (the ring: ${
          GHOST} s ahead). The wheel turns towards its lean, runs
        in a circle, and never leans by more than ${lean(wheel)}°.`,
      attempt:
          'Take its spin away. L gets shorter, the same M turns it faster; without any spin nothing turns, and it falls.',
      ask: {
        text: `This wheel starts with 15° of lean and 6 rad/s of spin. Flat on the ground is 90°. Draw into the diagram
          how its lean goes on; then play.`,
        until: 3,
      },
    },
    {
      title: 'What rights it',
      start: {lean: 15, spin: 6},
      controls: ['spin', 'lean'],
      picture: 'precession',
      diagrams: ['bars', 'lean'],
      eye: 'behind',
      speed: 0.25,
      text: (wheel) => {
        const {tips, rights} = wheel.perRadian;
        return `A moment that turns L does not tip the wheel. For a small lean, each radian of it brings two moments. One
          tips the wheel: m&nbsp;g&nbsp;r<sub>0</sub> = ${tips.toFixed(1)} N m. The other
          is what turning L takes from it, and so it rights the wheel: (J<sub>z</sub> + m R²)(J<sub>z</sub>/J<sub>x</sub>) ω² = ${
            (rights / spin(wheel) ** 2).toFixed(1)} ω² N m, with R = r<sub>0</sub> + r. The first does not depend on
          the spin, the second grows with its square.`;
      },
      attempt: 'Drag the spin until both bars are equal. Which spin is it?',
    },
    {
      title: 'The critical spin',
      start: {lean: 0.5, spin: slower},
      beside: {spin: faster},
      names: ['10 % slower', '10 % faster'],
      controls: ['lean'],
      picture: 'precession',
      diagrams: ['lean', 'bars'],
      eye: 'behind',
      text: (slow, fast) =>
          `Both moments are equal at ω<sub>crit</sub> = ${limit.toFixed(2)} rad/s. Above it the turn rights
        more than the weight tips: the faster wheel never leans by more than ${
              lean(fast)}°. Below it the lean grows until it is no
        longer small: the slower one leans by ${lean(slow)}°. The mass cancels, its distribution does not.`,
      attempt: 'Start with more lean: above which initial lean does the faster one, too, lean by more than 20°?',
      ask: {
        text: `Two wheels with half a degree of lean: one 10 % slower than ${
            limit.toFixed(2)} rad/s, one 10 % faster. Which of
          them leans by more than ${MEASURE}° within ten seconds?`,
        fates: ['Neither.', 'Only the slower one.', 'Only the faster one.', 'Both.'],
        right:
            (slow, fast) => [slow, fast].reduce((sum, wheel, i) => sum + (Number(lean(wheel)) > MEASURE) * (i + 1), 0),
        until: 6,
      },
    },
    {
      title: 'Down, and up again',
      start: PAPER,
      controls: ['spin', 'lean'],
      diagrams: ['lean', 'phase'],
      text: (wheel) =>
          `Far too slow to stay up, it comes down to a lean of ${lean(wheel)}°, turns fast about the vertical,
        and rises to its 15° again: nothing takes energy away. Every half swing is the one before, turned and mirrored,
        so the rate of θ = 90° − lean, over θ, is one closed curve, traced again and again.`,
      attempt: 'Change the spin: each motion has a closed curve of its own.',
      ask: {
        text: `The paper's wheel: 15° of lean and only 2 rad/s, too little to stay up; no rolling resistance. Draw into
          the diagram how its lean goes on for ten seconds; then play.`,
        until: 5,
      },
    },
    {
      title: 'Rolling resistance',
      start: {...PAPER, s: 0.03},
      controls: ['s', 'spin'],
      picture: 'resistance',
      diagrams: ['spin', 'hold'],
      eye: 'abreast',
      text: ({table, phases: {sticks: [[begin]], transitions}}) =>
          `A real road and a real tyre give way a little. Here all of that is one length: the force ${N} of the
        road acts s = 0.03 m ahead of the contact. So it has a moment s N about the axle, against the spin. At ${
              begin.toFixed(2)} s the spin
        is used up. From then on N moves only as far as it takes to <b class="stick">hold</b> the spin at zero; where that takes
        more than s N (the band), the wheel is released. In ${table.end.toFixed(0)} s it is held, released or reversed
        ${transitions.length} times.`,
      attempt: 'Lower s: the band gets narrow, and the first stop comes later.',
    },
    {
      title: 'Held, but turning',
      start: {...PAPER, s: 0.08, stop: 4},
      controls: ['s'],
      picture: 'resistance',
      diagrams: ['hold', 'energy'],
      speed: 0.25,
      at: 1,
      axes: true,
      text: (wheel) =>
          `Rolling resistance holds the turn about the axle e<sub>3</sub> and no other. So the held wheel nods
        and turns, as a coin that pivots on a table: while it is held for the first time, for
        ${whileHeld(wheel, 'time').toFixed(2)} s, its heading turns by ${
              (DEGREES * whileHeld(wheel, 'psi')).toFixed(0)}°. A
        moment does no work where nothing turns about its axis: E stays level while the wheel is held.`,
      attempt: 'Look at E where the wheel is <b class="stick">held</b>, and where it is not.',
    },
    {
      title: 'Pushed and braked',
      start: {
        lean: 2,
        spin: 4,
        changes: [[1, 'M_3', -4], [3, 'M_3', 0], [6, 'M_brake', 4], [7.5, 'M_brake', 0]].map(
            ([t, name, value]) => ({t, name, value})),
      },
      controls: ['push', 'spin'],
      diagrams: ['energy', 'spin'],
      text: (wheel) =>
          `A motor pushes with 4 N m about the axle from 1 s to 3 s: the energy rises from ${joules(wheel, 1)} J
        to ${joules(wheel, 3)} J. From 6 s to 7.5 s a dry brake takes it down to ${joules(wheel, 7.5)} J. Otherwise the
        energy is constant.`,
      attempt: 'Hold a button at any instant: the past stays, and a new future is computed at once.',
    },
    {
      title: 'Lock the wheel',
      start: {lean: 0, spin: 20, mu: 0.45, brake: 100, fork: true, stop: 4},
      controls: ['brake', 'mu'],
      picture: 'sliding',
      diagrams: ['circle', 'speeds'],
      eye: 'above',
      speed: 0.25,
      text: (wheel) => {
        const {slides: [[begin, end]], sticks: [[locked]]} = wheel.phases;
        const way = Math.hypot(...['X_O', 'Y_O'].map((name) => at(wheel, end)(name) - at(wheel, begin)(name)));
        const speed = at(wheel, 0)('v_x').toFixed(1);
        return `A fork holds this wheel upright, at ${speed} m/s. The brake rises to 100 N m within half a second, and
          with it the road's force, until it touches the outer circle, μ<sub>max</sub> N, at ${
            begin.toFixed(2)} s. There
          the grip is lost: the force drops to the inner circle, μ<sub>slide</sub> N, opposite to the slip. ${
            (locked - begin).toFixed(2)} s
          later the wheel is locked: ${TURN} is zero, and the ${SLIP} is ${V}. It slides
          ${way.toFixed(1)} m, decelerated by μ<sub>slide</sub> g = ${
            (wheel.parameters.mu_slide * g).toFixed(2)} m/s², however hard it is braked.`;
      },
      attempt: 'Brake with 53 N m: the force stays within the outer circle, the wheel rolls on, and it stops sooner.',
    },
    {
      title: 'Backspin',
      start: {lean: 0, spin: -10, speed: 2, mu: 0.35, stop: 4},
      controls: ['spin', 'mu'],
      picture: 'sliding',
      diagrams: ['speeds', 'circle'],
      eye: 'above',
      speed: 0.5,
      text: (wheel) => {
        const end = wheel.phases.slides[0][1];
        const {v: [v], turn: [turn], slip: [slip]} = contact(wheel.parameters, at(wheel, 0));
        return `Thrown forward at ${V} = ${v.toFixed(1)} m/s and spinning backward, ${TURN} = ${
            turn.toFixed(1)} m/s, the wheel
          touches the road with a ${SLIP} of ${
            slip.toFixed(1)} m/s: the sum of both. The road's force acts against the slip,
          μ<sub>slide</sub> N on the inner circle; it brakes v and the backspin alike. At ${end.toFixed(2)} s their
          sum is zero: the wheel rolls, and comes back at ${(-at(wheel, wheel.table.end)('v_x')).toFixed(2)} m/s.`;
      },
      attempt: 'Give it less backspin, −4 rad/s: it rolls while still moving forward.',
      ask: {
        text: `Thrown forward at 2 m/s, spinning backward at 10 rad/s, on a wet road. How does it move once it rolls?`,
        fates: ['It rolls on forward.', 'It stands still.', 'It comes back.'],
        right: (wheel) => 1 - Math.sign(Math.round(100 * at(wheel, wheel.table.end)('v_x'))),
        until: 2,
      },
    },
    {
      title: 'Free play',
      free: true,
      start: {...PAPER, s: 0, mu: 0, steer: 0, body: 'tyre'},
      controls: ['body', 'lean', 'spin', 's', 'mu', 'steer', 'push'],
      text: () =>
          `The wheel is yours. <b>Grip</b> 0 means that it never slides; otherwise it slides with 85 % of that friction
        coefficient. <b>Steer</b> puts it into a fork that turns it from 1 s on. A run ends where the wheel lies flat,
        where it would lift off (N = 0), and where it jams while it slides.`,
      attempt: 'Which of the four bodies needs the most spin to stay up? Roll a coin of your own across the desk.',
    },
  ];
}
