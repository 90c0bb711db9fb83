// The story of the live page: what the wheel does and why, step by step (docs/physics.md), and the scenes to begin
// with. Each step is a scene; its text takes every figure from the scene's own motion. wheel: {table, phases}; other:
// the motion that is kept beside. A scene is written as the address that shows it (address.js).
import {read} from '#address';
import {criticalSpin} from '#mechanics';
import {extent} from '#table';

const DEGREES = 180 / Math.PI;
const angle = (value) => (DEGREES * value).toFixed(1);
/** The largest lean of a motion from upright, in degrees. */
const lean = ({table}) => angle(extent(table.columns.theta.map((theta) => Math.abs(theta - Math.PI / 2)))[1]);
const spin = ({table}) => Math.abs(table.value('omega_z', 0)).toFixed(0);
const joules = ({table}, t) => table.value('E', t).toFixed(1);
/** By how much a quantity changes while friction holds the wheel for the first time. */
const whileHeld = ({table, phases: {sticks: [[begin, end]]}}, name) =>
    Math.abs(table.value(name, end) - table.value(name, begin));

/** A step of the story. more: {names: labels of both wheels, speed: of the clock}. */
const step = (title, address, text, attempt, more) => ({title, state: read(address).state, text, attempt, ...more});

/** The steps [{title, state, text(wheel, other), attempt, names?, speed?}] for the wheel's parameters by name. */
export function chapters(parameters) {
  const {m, r_0, r} = parameters;
  const limit = criticalSpin(parameters);
  const [slower, faster] = [0.9, 1.1].map((part) => (-part * limit).toFixed(3));
  const speed = ({table}) => Math.hypot(table.value('X_O_dot', 0), table.value('Y_O_dot', 0)).toFixed(2);
  return [
    step(
        'It rolls', 'theta=90deg&phi_dot=-5&diagram=path',
        (wheel) => `A wheel of ${m} kg, shaped as a torus, touches the ground at one point and does not slide there.
          Upright, it rolls straight on: a spin of ${spin(wheel)} rad/s times a radius of ${(r_0 + r).toFixed(2)} m is
          ${speed(wheel)} m/s.`,
        'Hold <b>push forward ▶</b> while it rolls, then <b>brake</b>, and watch the energy E.'),
    step(
        'Why it does not fall', 'theta=75deg&phi_dot=-6&diagram=path&show=follow+path+axes',
        (wheel) => `This one starts with 15° of lean, and never leans by more than ${lean(wheel)}°. A wheel that
          leans turns towards its lean, and the turn rights it. So it does not fall but runs in a circle, and nods a
          little.`,
        'Take its spin away: set φ̇ to 0. Nothing turns it now, and it falls.'),
    step(
        'The critical spin, from both sides',
        `theta=89.5deg&phi_dot=${slower}&kept.theta=89.5deg&kept.phi_dot=${faster}`,
        (wheel, other) => `Upright rolling is stable above ${limit.toFixed(2)} rad/s: below, the weight tips the
          wheel faster than the turn rights it. Both wheels start with half a degree of lean. The faster one sways by at
          most ${lean(other)}°, the slower one comes down by ${lean(wheel)}°.`,
        'Give the slower wheel more spin φ̇ and find where its swings become small.',
        {names: ['10 % slower', '10 % faster']}),
    step(
        'Half a swing, for ever', 's=0',
        (wheel) => `The paper's wheel has ${spin(wheel)} rad/s, too little to stay up. It comes down to θ =
          ${angle(extent(wheel.table.columns.theta)[0])}°, turns faster, and comes up again. Without friction every half
          swing is the one before, turned and mirrored: (θ, θ̇) is one closed curve, run through for ever.`,
        'Choose ω<sub>3</sub> (ω<sub>2</sub>) in the diagram: one arc, run to and fro. Then the path: a ring.'),
    step(
        'Rolling friction stops the spin', 's=0.03&diagram=spin',
        ({table, phases: {sticks: [[begin]], transitions}}) => `Rolling friction acts about the axle, against the
          spin, with at most s N. At ${begin.toFixed(2)} s the spin is used up, and friction holds it at zero (orange)
          until that takes more than s N. In ${table.end.toFixed(0)} s it is held, released or reversed
          ${transitions.length} times.`,
        'Go to the start and drag s down to 0.01 m: the first stop comes later.'),
    step(
        'Held, but nodding and turning', 's=0.03&t=1.1&show=follow+path+axes',
        (wheel) => `Friction holds the turn about the axle e₃. About the other two axes it gives no moment, so the held
          wheel nods and turns, as a coin that pivots on a table: in the first orange band,
          ${whileHeld(wheel, 'time').toFixed(2)} s long, its heading turns by ${
            (DEGREES * whileHeld(wheel, 'psi')).toFixed(0)}°. What does not move takes
          no energy: E stays level while it is held.`,
        'Play it at a quarter of the speed. Look at E where the band is orange, and where it is not.', {speed: 0.25}),
    step(
        'Pushed and braked', 'theta=88deg&phi_dot=-4&M_3=1:-4,3:0&M_brake=6:4,7.5:0&diagram=path',
        (wheel) => `A motor pushes with 4 N m about the axle from 1 s to 3 s: the energy rises from
          ${joules(wheel, 1)} J to ${joules(wheel, 3)} J. From 6 s to 7.5 s a dry brake acts and takes it down to
          ${joules(wheel, 7.5)} J. Between them, and after, the energy stays what it is.`,
        'Hold a button anywhere on the way: the past stays, and a new future is computed at once.'),
    step(
        'What ends a run', 'phi_dot=0',
        ({table}) => `Let go without spin, it falls. At ${table.end.toFixed(2)} s it lies flat and touches the ground
          along a circle instead of a point: the equations end there, and so does the run. It also ends where the wheel
          would lift off (N = 0), and, with a static friction coefficient μ but no kinetic one μ_s, where rolling would
          need more.`,
        'Give it a little spin φ̇. How little lets it come up again?'),
  ];
}

/** The scenes {label, plan, about}: those of the story's steps, and a disc; for the wheel's parameters. */
export function scenes(parameters, steps) {
  const [, , critical, free, friction, , driven] = steps.map(({state}) => state);
  const limit = `Upright rolling is stable above ${criticalSpin(parameters).toFixed(2)} rad/s; this wheel is 10 %`;
  const disc = read('body=disc&r=0&theta=20deg&psi_dot=9&phi_dot=-9').state;
  return [
    ['Paper, no friction', free.plan],
    ['Paper, s = 0.03 m', friction.plan],
    ['Just stable', critical.kept, `${limit} faster, leans by half a degree and stays up.`],
    ['Just unstable', critical.plan, `${limit} slower, leans as much and tumbles.`],
    [
      'Thin disc', disc.plan,
      'No tube (r = 0), homogeneous: the rolling disc of the textbooks, low and wobbling like a coin.'
    ],
    ['Driven', driven.plan, 'A motor pushes with M₃ = −4 N m from 1 s to 3 s, the brake with 4 N m from 6 s to 7.5 s.'],
  ].map(([label, plan, about]) => ({label, plan, about}));
}
