// The story of the live page: what the wheel does and why, step by step (docs/physics.md), and the scenes to begin
// with. Each step is a scene; its text takes every figure from the scene's own motion. wheel: {table, phases}; other:
// the motion that is kept beside. A scene is written as the address that shows it (address.js).
import {read} from '#address';
import {DEGREES} from '#dom';
import {balance, criticalSpin} from '#mechanics';
import {extent} from '#table';

const angle = (value) => (DEGREES * value).toFixed(1);
/** The largest lean of a motion from upright, in degrees. */
const lean = ({table}) => angle(extent(table.columns.theta.map((theta) => Math.abs(theta - Math.PI / 2)))[1]);
const spin = ({table}, digits = 0) => Math.abs(table.value('omega_z', 0)).toFixed(digits);
/** The first instant, s, of a lean of 5 degrees. */
const tips = ({table: {columns: {time, theta}}}) =>
    time[theta.findIndex((angle) => Math.abs(angle - Math.PI / 2) > 5 / DEGREES)];
/** The speed along e1, m/s. */
const ahead = (table, t) => table.value('X_O_dot', t) * Math.cos(table.value('psi', t)) +
    table.value('Y_O_dot', t) * Math.sin(table.value('psi', t));
const grips = ({phases: {slides: [[, end]]}}) => end;
const joules = ({table}, t) => table.value('E', t).toFixed(1);
/** The first instant, s, at which a wheel with theta < 90 deg leans most, and the moments about e1 there, N m. */
const deepest = ({table, parameters}) => {
  const {theta, time} = table.columns;
  const t = time[theta.findIndex((angle, i) => angle < theta[i + 1])];
  return {t, ...balance(parameters, (name) => table.value(name, t))};
};
/** By how much a quantity changes while friction holds the wheel for the first time. */
const whileHeld = ({table, phases: {sticks: [[begin, end]]}}, name) =>
    Math.abs(table.value(name, end) - table.value(name, begin));

/**
 * A step of the story. more: {names: labels of both wheels, speed: of the clock, balance: whether it is shown,
 * question: {text, until: s at which the motion has answered, fates, right(wheel, other): the number of the true one}};
 * without fates the reader draws the tilt over time.
 */
const step = (title, address, text, attempt, more) => ({title, state: read(address).state, text, attempt, ...more});

/** The steps for the wheel's parameters by name. */
export function chapters(parameters) {
  const {m, r_0, r} = parameters;
  const limit = criticalSpin(parameters);
  const [slower, faster] = [0.9, 1.1].map((part) => (-part * limit).toFixed(3));
  const speed = ({table}, t = 0) => Math.hypot(table.value('X_O_dot', t), table.value('Y_O_dot', t)).toFixed(2);
  return [
    step(
        'It rolls. And then?', `theta=89.5deg&phi_dot=${slower}&diagram=path`,
        (wheel) => `A wheel of ${m} kg, shaped as a torus, touches the ground at one point and does not slide there. So
          its spin of ${spin(wheel, 1)} rad/s times its radius of ${(r_0 + r).toFixed(2)} m is its speed,
          ${speed(wheel)} m/s. Half a degree of lean is enough: at ${tips(wheel).toFixed(1)} s it leans by 5°, and comes
          down. Not every wheel does. The next steps show what rights it.`,
        'From the start, hold <b>push forward ▶</b> for a second: it stays up. Watch the energy E.'),
    step(
        'Why it does not fall', 'theta=75deg&phi_dot=-6&diagram=path&show=follow+path+axes',
        (wheel) => `This one starts with 15° of lean, and never leans by more than ${lean(wheel)}°. A wheel that
          leans turns towards its lean, and the turn rights it. So it does not fall but runs in a circle, and nods a
          little.`,
        'Take its spin away: set φ̇ to 0. Nothing turns it now, and it falls.', {
          question: {
            text: `This wheel starts with 15° of lean, θ = 75°, and 6 rad/s of spin. Flat on the ground is θ = 0°. Draw
              into the diagram of θ how it goes on; then play.`,
            until: 3,
          }
        }),
    step(
        'What rights it', 'theta=75deg&phi_dot=-6&diagram=spin',
        (wheel) => {
          const {t, weight, side, gyro} = deepest(wheel);
          return `The same wheel, seen from behind. The road carries its weight beside the centre, which tips it. While
          it tips, its spin turns it, and the turn rights it twice: by the gyroscopic moment, and by the side force of
          the road, which bends the path. Where it leans most, at ${t.toFixed(2)} s, they have
          ${gyro.toFixed(1)} N m and ${side.toFixed(1)} N m against ${(-weight).toFixed(1)} N m.`;
        },
        'Pause anywhere: the first three moments add up to the last, J<sub>x</sub> θ̈. Where does it change its sign?',
        {speed: 0.25, balance: true}),
    step(
        'The critical spin, from both sides',
        `theta=89.5deg&phi_dot=${slower}&kept.theta=89.5deg&kept.phi_dot=${faster}`,
        (wheel, other) => `Upright rolling is stable above ${limit.toFixed(2)} rad/s: below, the weight tips the
          wheel faster than the turn rights it. Both wheels start with half a degree of lean. The faster one sways by at
          most ${lean(other)}°, the slower one comes down by ${lean(wheel)}°.`,
        'Give the slower wheel more spin (φ̇) and find where its swings become small.', {
          names: ['10 % slower', '10 % faster'],
          question: {
            text:
                `Two wheels with half a degree of lean, one with a spin 10 % below ${limit.toFixed(2)} rad/s, the other
              10 % above. What becomes of them in ten seconds?`,
            fates: ['Both stay up.', 'Only the faster one stays up.', 'Both come down.'],
            right: (...wheels) => wheels.filter((wheel) => lean(wheel) > 20).length,
            until: 3,
          },
        }),
    step(
        'Half a swing, for ever', 's=0',
        (wheel) => `The paper's wheel has ${spin(wheel)} rad/s, too little to stay up. It comes down to θ =
          ${angle(extent(wheel.table.columns.theta)[0])}°, turns faster, and comes up again. Without friction every half
          swing is the one before, turned and mirrored: (θ, θ̇) is one closed curve, run through for ever.`,
        'Choose ω<sub>z</sub> (ω<sub>2</sub>) in the diagram: one arc, run to and fro. Then the path: a ring.', {
          question: {
            text: `The paper's wheel: 15° of lean and only 2 rad/s, too little to stay up; no friction. Draw into the
              diagram of θ how it goes on for ten seconds; then play.`,
            until: 5,
          }
        }),
    step(
        'Rolling resistance stops the spin', 's=0.03&diagram=spin',
        ({table, phases: {sticks: [[begin]], transitions}}) => `Rolling resistance acts about the axle, against the
          spin, with at most s N. At ${begin.toFixed(2)} s the spin is used up, and it is held at zero (orange)
          until that takes more than s N. In ${table.end.toFixed(0)} s it is held, released or reversed
          ${transitions.length} times.`,
        'Go to the start and drag s down to 0.01 m: the first stop comes later.'),
    step(
        'Held, but nodding and turning', 's=0.03&t=1.1&show=follow+path+axes',
        (wheel) =>
            `Rolling resistance holds the turn about the axle e₃. About the other two axes it has no moment, so the held
          wheel nods and turns, as a coin that pivots on a table: over the first orange mark,
          ${whileHeld(wheel, 'time').toFixed(2)} s long, its heading turns by ${
                (DEGREES * whileHeld(wheel, 'psi')).toFixed(0)}°. A held spin dissipates
          nothing: E stays level while it is held.`,
        'Look at E over the orange marks, and beside them.', {speed: 0.25}),
    step(
        'Pushed and braked', 'theta=88deg&phi_dot=-4&M_3=1:-4,3:0&M_brake=6:4,7.5:0&diagram=path',
        (wheel) => `A motor pushes with 4 N m about the axle from 1 s to 3 s: the energy rises from
          ${joules(wheel, 1)} J to ${joules(wheel, 3)} J. From 6 s to 7.5 s a dry brake acts and takes it down to
          ${joules(wheel, 7.5)} J. Otherwise the energy is constant.`,
        'Hold a button at any instant: the past stays, and a new future is computed at once.'),
    step(
        'Lock the wheel',
        'guided=true&theta=90deg&phi_dot=-20&mu_max=0.45&mu_slide=0.4&M_brake=0.5:300&stop=4&diagram=path&show=follow+path+force',
        (wheel) => {
          const [[begin, end]] = wheel.phases.slides;
          const way = Math.hypot(
              ...['X_O', 'Y_O'].map((name) => wheel.table.value(name, end) - wheel.table.value(name, begin)));
          const locked = wheel.table.time[wheel.table.columns.omega_z.findIndex((omega) => omega === 0)] - begin;
          return `A fork holds this wheel upright. At ${begin.toFixed(1)} s a brake of 300 N m locks it: within
            ${locked.toFixed(2)} s the speed of rolling, −R ω<sub>z</sub> (dashed), is zero; v is not. The road slows a
            sliding wheel by μ<sub>slide</sub> g, however hard it is braked. It slides ${way.toFixed(1)} m,
            v²/(2 μ<sub>slide</sub> g).`;
        },
        'Go to 0.5 s and type 50 N m for M<sub>b</sub>: it rolls on, its grip is the static one, and it stops sooner.',
        {speed: 0.5}),
    step(
        'Thrown with backspin',
        'theta=90deg&phi_dot=10&slip_x=5.5&mu_max=0.35&mu_slide=0.3&stop=4&diagram=path&show=follow+path+force',
        (wheel) =>
            `Thrown forward at ${speed(wheel)} m/s and spinning backward at ${spin(wheel)} rad/s, the wheel slides
          (purple): its point at the contact moves over the road by the slip, the purple arrow, and the road brakes it with
          μ<sub>slide</sub> N. At ${
                grips(wheel).toFixed(1)} s v and −R ω<sub>z</sub> (dashed) meet: the slip is used up.
          It rolls, and comes back at ${speed(wheel, 1)} m/s.`,
        'Give it less backspin: φ̇ = 4 rad/s, u<sub>x</sub> = 3.4 m/s. It rolls while still moving forward.', {
          speed: 0.5,
          question: {
            text: `Thrown forward at 2 m/s, spinning backward at 10 rad/s, onto a road with μ<sub>slide</sub> = 0.3. How
              does it move once it rolls?`,
            fates: ['It rolls on forward.', 'It stands still.', 'It comes back.'],
            right: ({table}) => 1 - Math.sign(Math.round(100 * ahead(table, table.end))),
            until: 2,
          },
        }),
    step(
        'What ends a run', 'phi_dot=0',
        ({table}) => `Released without spin, it falls. At ${table.end.toFixed(2)} s it lies flat and touches the ground
          along a circle instead of a point: the equations no longer hold, and the run ends. It also ends where the wheel
          would lift off (N = 0), where it jams while it slides, and, with a static friction coefficient μ<sub>max</sub> but no
          kinetic one μ<sub>slide</sub>, where rolling would need more.`,
        'Give it a little spin (φ̇). How little lets it come up again?'),
  ];
}

/** The scenes {label, plan, about}: those of the story's steps, a disc, and a wet road, for the wheel's parameters. */
export function scenes(parameters, steps) {
  const [, , , critical, free, friction, , driven, locked, thrown] = steps.map(({state}) => state);
  const limit = `Upright rolling is stable above ${criticalSpin(parameters).toFixed(2)} rad/s; this wheel is 10 %`;
  const wet = read('mu_max=0.45&mu_slide=0.4&show=follow+path+force').state;
  const steered =
      read('guided=true&theta=90deg&phi_dot=-20&psi_dot_guide=1:0.8,4:-0.8,8:0&show=follow+path+force').state;
  const disc = read('body=disc&r=0&theta=20deg&psi_dot=9&phi_dot=-9').state;
  return [
    ['Paper, no friction', free.plan],
    ['Paper, s = 0.03 m', friction.plan],
    ['Just stable', critical.kept, `${limit} faster, leans by half a degree and stays up.`],
    ['Just unstable', critical.plan, `${limit} slower, leans as much, comes down and rises again.`],
    [
      'Thin disc', disc.plan,
      'No tube (r = 0), homogeneous: the rolling disc of the textbooks, low and wobbling like a coin.'
    ],
    [
      'Wet road', wet.plan,
      'The paper\'s wheel with μ_max = 0.45 (static) and μ_slide = 0.4 (kinetic): it slides twice.'
    ],
    ['Backspin', thrown.plan, 'Thrown forward at 2 m/s, spinning backward: it slides, rolls and comes back.'],
    ['Locked', locked.plan, 'In a fork at 7 m/s; a brake locks it at 0.5 s, and it slides until it stops.'],
    [
      'Steered', steered.plan,
      'On its carrier at 7 m/s, steered left, then right: the side force m v ψ̇ bends its path, the moment (J_z + m R²) ω_z ψ̇ of the carrier keeps it upright.'
    ],
    ['Driven', driven.plan, 'A motor pushes with M₃ = −4 N m from 1 s to 3 s, the brake with 4 N m from 6 s to 7.5 s.'],
  ].map(([label, plan, about]) => ({label, plan, about}));
}
