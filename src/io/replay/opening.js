// Where the page begins: when and where there is traffic.

/// Index of the first step at which half of what is usual later is there.
function openingStep(alive) {
  if (!alive.length) return 0;
  const sorted = [...alive].sort((a, b) => a - b), usual = sorted[Math.floor(0.75 * (sorted.length - 1))];
  const found = alive.findIndex(count => count > 0 && count >= usual / 2);
  return Math.max(found, 0);
}

/// Middle of the window of this size that holds the most points, and how many; null without any.
function densestPlace(xs, ys, wide, tall) {
  const cells = new Map(), cellX = wide / 4, cellY = tall / 4;
  for (let i = 0; i < xs.length; ++i) {
    const key = Math.floor(xs[i] / cellX) + ',' + Math.floor(ys[i] / cellY);
    cells.set(key, (cells.get(key) || 0) + 1);
  }
  let best = null;
  for (const key of cells.keys()) {
    const [column, row] = key.split(',').map(Number);
    let count = 0, x = 0, y = 0;
    for (let i = -2; i < 2; ++i) for (let j = -2; j < 2; ++j) {
      const inside = cells.get((column + i) + ',' + (row + j)) || 0;
      count += inside;
      x += inside * (column + i + 0.5) * cellX; y += inside * (row + j + 0.5) * cellY;
    }
    if (!best || count > best.count) best = {x: x / count, y: y / count, count};
  }
  return best;
}
