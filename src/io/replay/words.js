// What is known of agents and moments, in words. The numbers are those of the enumerations in src: LimitReason, BindingKind,
// ConstraintKind, Control, ReplayEventKind.

const kReason = {none: 0, signal: 1, yield: 2, crossing: 3, blocked: 4, leader: 5, stop: 6, merge: 7, givesWay: 8, turningRoom: 9, letsIn: 10};
const kBind = {none: 0, kinematic: 1, neighbour: 2, obstacle: 3, boundary: 4, direction: 5, road: 6, guard: 7, backing: 8};
const kDrivers = ['GAMMA', 'SUMO', 'nobody: parked', 'a planner (the ego)'];
// of those whom GAMMA doesn't drive
const kBehaviours = ['', 'as SUMO has it', 'parked', 'as its planner decides'];

/// What a colour or a line of the legend stands for.
const kLimits = ['free', 'signal', 'gives way', 'leader', 'junction blocked', 'stop, lane change', 'keeps clear of others',
  'walls, edges', 'its own body', 'emergency', 'not known'];
const kLimitOfReason = [0, 1, 2, 2, 4, 3, 5, 5, 2, 4, 2];
const kLimitOfBind = [0, 8, 6, 7, 7, 7, -1, 9, 9];

/// Index into kLimits of an agent at a step; by SUMO's drivers it isn't known.
function limitOf(state, bind) {
  const control = state >> 5 & 3, reason = state & 15;
  if (control !== 0) return kLimits.length - 1;
  if (bind === kBind.road) return kLimitOfReason[reason] || 1;
  if (bind < kLimitOfBind.length) return kLimitOfBind[bind];
  return kLimits.length - 1;
}

/// A sentence without its subject; `foe`: whose name goes into it, empty for nobody's.
function limitWords(state, bind, foe) {
  const control = state >> 5 & 3, other = foe || 'somebody';
  if (control === 1) return 'as SUMO decides';
  if (control === 2) return 'parked';
  if (control === 3) return 'as its planner decides';
  switch (bind) {
    case kBind.none: return 'nothing holds it back';
    case kBind.kinematic: return 'can turn and speed up no faster than its body';
    case kBind.neighbour: return 'keeps clear of ' + other;
    case kBind.obstacle: return 'keeps clear of a house or wall';
    case kBind.boundary: return 'keeps to its lane';
    case kBind.direction: return 'keeps its direction';
    case kBind.guard: return 'brakes, or it could not stop before others';
    case kBind.backing: return 'backs out of a deadlock';
  }
  switch (state & 15) {
    case kReason.signal: return foe ? `waits for a signal behind ${foe}` : 'waits for a signal';
    case kReason.yield: return 'gives way to ' + other;
    case kReason.crossing: return foe ? `lets ${foe} cross` : 'lets people cross';
    case kReason.blocked: return foe ? `keeps the junction clear, ${foe} fills it` : 'keeps the junction clear';
    case kReason.leader: return 'follows ' + other;
    case kReason.stop: return 'halts at a stop';
    case kReason.merge: return foe ? `changes lanes behind ${foe}` : 'has to change lanes first';
    case kReason.givesWay: return foe ? `has backed out for ${foe}` : 'has backed out';
    case kReason.turningRoom: return foe ? `leaves ${foe} room to turn` : 'leaves room to turn';
    case kReason.letsIn: return `lets ${other} in`;
  }
  return 'stays off a red crossing';
}

const kPlaneKinds = ['K, its body', 'G', 'C, house or wall', 'C, lane edge', 'C, direction', 'C, road'];
/// 'K', 'C' or 'G' of a half-plane's kind.
const planeSet = kind => kPlaneKinds[kind][0];

const kFigures = {none: 0, values: 1, meetings: 2};
const kFigureNames = ['', 'what each choice is worth: lower and upper bound', 'futures in which the ego meets somebody'];

function accelerationWords(acceleration) {
  if (Math.abs(acceleration) < 0.05) return 'keeps its speed';
  return (acceleration > 0 ? 'speeds up by ' : 'brakes by ') + `${Math.abs(acceleration).toFixed(1)} m/s²`;
}

/// What the ego does from a plan on.
function planWords({time, action, acceleration, steering}) {
  let words = action === 2 ? 'follows a trajectory' : accelerationWords(acceleration);
  if (action === 1) words += `, front wheels ${Math.abs(steering * 180 / Math.PI).toFixed(0)}° ${steering < 0 ? 'right' : 'left'}`;
  return `plan of ${clockText(time)}: ${words}`;
}

function figureWords(figures, {lower, upper}) {
  if (lower === undefined) return 'not looked at';
  if (figures === kFigures.meetings) return `${(100 * lower).toFixed(0)} %`;
  const short = value => value.toFixed(Math.abs(value) < 100 ? 2 : 0);
  return `${short(lower)} … ${short(upper)}`;
}

/// Where a way ends up against where its agent points: see turnOf.
function wayWords(turn) {
  if (turn === null) return 'stops';
  const degrees = turn * 180 / Math.PI;
  if (Math.abs(degrees) < 25) return 'goes on';
  return Math.abs(degrees) > 135 ? 'turns back' : degrees > 0 ? 'turns left' : 'turns right';
}

const kEvents = [
  {name: 'collision', plural: 'collisions', shape: 'cross'},
  {name: 'red light run', plural: 'red lights run', shape: 'square'},
  {name: 'stuck', plural: 'stuck', shape: 'bar'},
  {name: 'conflict', plural: 'conflicts', shape: 'triangle', hint: 'less than 1.5 s to a collision (FHWA)'},
  {name: 'encounter', plural: 'encounters', shape: 'ring', hint: 'beyond the thresholds of SUMO’s SSM device alone', quiet: true},
  {name: 'wrong way', plural: 'wrong way', shape: 'square'},
  {name: 'off the road', plural: 'off the road', shape: 'square'},
  {name: 'on a sidewalk', plural: 'on sidewalks', shape: 'square'},
];

/// 'car.1 and pedestrian.2: crossing, 0.9 s to a collision'
function eventWords(event, nameOf) {
  const who = event.b >= 0 ? `${nameOf(event.a)} and ${nameOf(event.b)}` : nameOf(event.a);
  return who + (event.words ? ': ' + event.words : '');
}
