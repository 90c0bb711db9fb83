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
const grips = ({phases: {slides: [[, end]]}}) => end;
const joules = ({table}, t) => table.value('E', t).toFixed(1);
/** The largest rate of the turn about e2, rad/s. */
const turn = ({table: {columns: {psi_dot, theta}}}) =>
    extent(psi_dot.map((rate, i) => Math.abs(rate * Math.sin(theta[i]))))[1].toFixed(2);
/** By how much a quantity changes while friction holds the wheel for the first time. */
const whileHeld = ({table, phases: {sticks: [[begin, end]]}}, name) =>
    Math.abs(table.value(name, end) - table.value(name, begin));

/** A step of the story. more: {names: labels of both wheels, speed: of the clock, moment: whether it is drawn}. */
const step = (title, address, text, attempt, more) => ({title, state: read(address).state, text, attempt, ...more});

/** The steps [{title, state, text(wheel, other), attempt, names?, speed?}] for the wheel's parameters by name. */
export function chapters(parameters) {
  const {m, r_0, r} = parameters;
  const limit = criticalSpin(parameters);
  const [slower, faster] = [0.9, 1.1].map((part) => (-part * limit).toFixed(3));
  const speed = ({table}, t = 0) => Math.hypot(table.value('X_O_dot', t), table.value('Y_O_dot', t)).toFixed(2);
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
        'What rights it', 'theta=75deg&phi_dot=-6&diagram=spin&show=follow+path+axes+force',
        (wheel) =>
            `The same wheel, with the ground's force (red, from the contact) and the gyroscopic moment of its spin (from the centre). While it
          tips, the moment points along e<sub>2</sub> and turns it: ω<sub>2</sub> grows to ${turn(wheel)} rad/s. Once it
          turns, the moment points along e<sub>1</sub>, and with the ground's force, which bends its path, rights it. Below
          stands the equation of the turn with its terms.`,
        'Pause where it leans most: θ̇ is zero, so is the first term, and the moment lies along e<sub>1</sub>.',
        {speed: 0.25, moment: true}),
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
            (DEGREES * whileHeld(wheel, 'psi')).toFixed(0)}°. Friction at rest dissipates
          nothing: E stays level while it is held.`,
        'Play it at a quarter of the speed. Look at E where the band is orange, and where it is not.', {speed: 0.25}),
    step(
        'Pushed and braked', 'theta=88deg&phi_dot=-4&M_3=1:-4,3:0&M_brake=6:4,7.5:0&diagram=path',
        (wheel) => `A motor pushes with 4 N m about the axle from 1 s to 3 s: the energy rises from
          ${joules(wheel, 1)} J to ${joules(wheel, 3)} J. From 6 s to 7.5 s a dry brake acts and takes it down to
          ${joules(wheel, 7.5)} J. Otherwise the energy is constant.`,
        'Hold a button at any instant: the past stays, and a new future is computed at once.'),
    step(
        'Thrown with backspin',
        'theta=90deg&phi_dot=10&slip_x=5.5&mu_max=0.35&mu_slide=0.3&stop=4&diagram=path&show=follow+path+force',
        (wheel) =>
            `Thrown forward at ${speed(wheel)} m/s and spinning backward at ${spin(wheel)} rad/s, the wheel slides
          (purple): its point at the contact moves over the road by the slip, the purple arrow, and the road brakes it with
          μ<sub>s</sub> N. At ${grips(wheel).toFixed(1)} s the slip is used up. It rolls, and comes back at ${
                speed(wheel, 1)} m/s.`,
        'Give it less backspin: φ̇ = 4 rad/s, u<sub>x</sub> = 3.4 m/s. It rolls while still moving forward.',
        {speed: 0.5}),
    step(
        'What ends a run', 'phi_dot=0',
        ({table}) => `Released without spin, it falls. At ${table.end.toFixed(2)} s it lies flat and touches the ground
          along a circle instead of a point: the equations no longer hold, and the run ends. It also ends where the wheel
          would lift off (N = 0), where it jams while it slides, and, with a static friction coefficient μ but no
          kinetic one μ<sub>s</sub>, where rolling would need more.`,
        'Give it a little spin φ̇. How little lets it come up again?'),
  ];
}

/** The scenes {label, plan, about}: those of the story's steps, a disc, and a wet road; for the wheel's parameters. */
export function scenes(parameters, steps) {
  const [, , , critical, free, friction, , driven, thrown] = steps.map(({state}) => state);
  const limit = `Upright rolling is stable above ${criticalSpin(parameters).toFixed(2)} rad/s; this wheel is 10 %`;
  const wet = read('mu_max=0.45&mu_slide=0.4&show=follow+path+force').state;
  const disc = read('body=disc&r=0&theta=20deg&psi_dot=9&phi_dot=-9').state;
  return [
    ['Paper, no friction', free.plan],
    ['Paper, s = 0.03 m', friction.plan],
    ['Just stable', critical.kept, `${limit} faster, leans by half a degree and stays up.`],
    ['Just unstable', critical.plan, `${limit} slower, leans as much and falls over.`],
    [
      'Thin disc', disc.plan,
      'No tube (r = 0), homogeneous: the rolling disc of the textbooks, low and wobbling like a coin.'
    ],
    ['Wet road', wet.plan, 'The paper\'s wheel with μ = 0.45 (static) and μ_s = 0.4 (kinetic): it slides twice.'],
    ['Backspin', thrown.plan, 'Thrown forward at 2 m/s, spinning backward: it slides, rolls and comes back.'],
    ['Driven', driven.plan, 'A motor pushes with M₃ = −4 N m from 1 s to 3 s, the brake with 4 N m from 6 s to 7.5 s.'],
  ].map(([label, plan, about]) => ({label, plan, about}));
}
