// Colours and names.

const kTypeColours = {
  car: '#4d9fec', van: '#8a78f2', bus: '#f2c037', truck: '#b5835a', motorcycle: '#ec5aa5', bicycle: '#3ccb8f',
  pedestrian: '#ff8a3d', electric_tricycle: '#b6d23c', gyro_scooter: '#43d3df',
};
const kSpareColours = ['#d7dde4', '#e36d6d', '#7fb069', '#a0c4ff', '#e0aaff'];
const kReasons = ['nothing', 'signal', 'yield', 'crossing', 'blocked junction', 'leader', 'stop', 'end of path'];
const kReasonColours = ['#3ccb8f', '#f2545b', '#f2c037', '#ff8a3d', '#b070ff', '#4d9fec', '#9aa5b1', '#d7dde4'];
const kEventNames = ['collision', 'red light run', 'stuck'];
const kEventPlurals = ['collisions', 'red lights run', 'stuck'];
const kEventColours = ['#ff3b47', '#ff9f1a', '#b070ff'];
const typeColour = map.types.map((type, i) => kTypeColours[type.name] || kSpareColours[i % kSpareColours.length]);
const hidden = new Set();
let css = {};

function readTheme() {
  const style = getComputedStyle(root);
  for (const name of ['ground', 'road', 'walk', 'area', 'cycle', 'rail', 'building', 'wall', 'mark', 'middle', 'zebra', 'bridge',
    'text', 'dim', 'accent', 'outline', 'glass', 'halo', 'line']) css[name] = style.getPropertyValue('--' + name).trim();
}

function speedColour(speed) {
  const share = Math.min(speed / 14, 1);
  return `hsl(${Math.round(4 + 140 * share)} 78% ${Math.round(58 - 8 * share)}%)`;
}
