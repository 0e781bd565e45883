// Agents, each as a body of its kind.

function colourOf(agent) {
  if (paint === 'speed') return speedColour(pose.speed);
  if (paint === 'reason') return kLimitColours[limitOf(pose.state, pose.bind)];
  return typeColour[agent.type];
}

const kDriverWidths = [0.8, 1.6, 0.8, 3];
function outlinePath(agent) {
  screen.beginPath();
  if (agent.box) {
    const l = agent.front - agent.back, w = agent.left - agent.right;
    const r = Math.min(0.32 * w, 0.45);
    screen.roundRect(agent.back, agent.right, l, w, r);
    return;
  }
  agent.outline.forEach(([x, y], i) => i ? screen.lineTo(x, y) : screen.moveTo(x, y));
  screen.closePath();
}

function drawWalker(agent) {
  const w = agent.left - agent.right, l = agent.front - agent.back;
  screen.beginPath();
  screen.ellipse(0, 0, l / 2, w / 2, 0, 0, 2 * Math.PI);
  screen.fill(); screen.stroke();
  screen.fillStyle = css.glass;
  screen.beginPath();
  screen.arc(0.06 * l, 0, 0.27 * w, 0, 2 * Math.PI);
  screen.fill();
}

function drawTwoWheeler(agent) {
  const w = agent.left - agent.right, l = agent.front - agent.back;
  screen.globalAlpha = 0.5;
  outlinePath(agent); screen.fill();
  screen.globalAlpha = 1;
  screen.beginPath();
  screen.roundRect(agent.back, -0.13 * w, l, 0.26 * w, 0.12 * w);
  screen.fill(); screen.stroke();
  screen.beginPath();
  screen.ellipse(agent.back + 0.42 * l, 0, 0.14 * l, 0.38 * w, 0, 0, 2 * Math.PI);
  screen.fill(); screen.stroke();
  screen.fillStyle = css.glass;
  screen.beginPath();
  screen.arc(agent.back + 0.45 * l, 0, 0.2 * w, 0, 2 * Math.PI);
  screen.fill();
}

function drawCar(agent, name, detailed) {
  const w = agent.left - agent.right, l = agent.front - agent.back;
  outlinePath(agent);
  screen.fill(); screen.stroke();
  screen.fillStyle = css.glass;
  const band = (from, to, inset, taper) => {
    screen.beginPath();
    screen.moveTo(agent.front - from, w / 2 - inset - taper); screen.lineTo(agent.front - from, -w / 2 + inset + taper);
    screen.lineTo(agent.front - to, -w / 2 + inset); screen.lineTo(agent.front - to, w / 2 - inset);
    screen.closePath(); screen.fill();
  };
  if (name === 'bus') {
    band(0.25, 1.0, 0.2, 0);
    if (detailed) { screen.globalAlpha = 0.22; for (let x = 2.2; x < l - 1.2; x += 2.6) band(x, x + 1.5, 0.42, 0); }
  } else if (name === 'truck') {
    band(0.2, 0.8, 0.25, 0.05);
    band(1.9, 2.12, 0, 0);
  } else {
    // bonnet, windscreen, roof, rear window
    band(0.22 * l, 0.36 * l, 0.14 * w, 0.05 * w);
    if (detailed) band(l - 0.06 * l, l - 0.17 * l, 0.16 * w, 0.05 * w);
  }
  screen.globalAlpha = 1;
  if (detailed && pose.slowing) {
    screen.fillStyle = '#ff2d3a';
    const size = Math.min(0.16 * w, 0.35);
    screen.fillRect(agent.back, w / 2 - 0.34 * w, 0.18, size);
    screen.fillRect(agent.back, -w / 2 + 0.34 * w - size, 0.18, size);
  }
}

const kTwoWheelers = new Set(['bicycle', 'motorcycle', 'electric_tricycle', 'gyro_scooter']);

function drawAgent(agent) {
  const sx = toScreenX(pose.x), sy = toScreenY(pose.y);
  if (sx < -80 || sy < -80 || sx > width + 80 || sy > height + 80) return;
  const type = map.types[agent.type];
  const l = agent.front - agent.back;
  const colour = colourOf(agent);
  // small bodies stay visible from afar
  const w = agent.left - agent.right;
  const s = Math.max(view.scale, (type.walks ? 4.8 : 8) / Math.max(l, 0.4), (type.walks ? 4.8 : 3.6) / Math.max(w, 0.4));
  const cos = Math.cos(pose.h) * s * dpr, sin = Math.sin(pose.h) * s * dpr;
  screen.setTransform(cos, -sin, -sin, -cos, sx * dpr, sy * dpr);
  screen.fillStyle = colour;
  screen.strokeStyle = css[kDriverColours[pose.control]];
  screen.lineWidth = kDriverWidths[pose.control] / s;
  if (s * l < 5.5) {
    screen.beginPath();
    screen.arc(0, 0, 2.4 / s, 0, 2 * Math.PI);
    screen.fill(); screen.stroke();
  } else if (s * l < 14) {
    // from afar a plain body does, and there may be thousands
    screen.fillRect(agent.back, agent.right, l, w);
    screen.strokeRect(agent.back, agent.right, l, w);
  } else if (type.walks) {
    drawWalker(agent);
  } else if (kTwoWheelers.has(type.name) && s * l > 16) {
    drawTwoWheeler(agent);
  } else {
    drawCar(agent, type.name, s > 5);
  }
  if (agent === followed || agent === hovered) {
    screen.setTransform(dpr, 0, 0, dpr, 0, 0);
    screen.strokeStyle = agent === followed ? css.accent : css.halo;
    screen.lineWidth = 2;
    screen.beginPath();
    screen.arc(sx, sy, Math.max(l * view.scale * 0.75, 11), 0, 2 * Math.PI);
    screen.stroke();
  }
}
