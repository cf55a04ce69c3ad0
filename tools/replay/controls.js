// Controls and texts of the page. Texts from the data are always set as text, never as markup.
const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 4, 8];
const KEYS = [['space', 'play or pause'], ['← →', 'go 0.1 s back or forward; with shift, 1 s'], ['Home End', 'go to the start or the end'],
  ['+ −', 'play faster or slower'], ['F', 'follow the robot, or show the whole path'], ['1 … 9', 'show or hide truth and methods'],
  ['P', 'place the lidar points with the next motion'], ['G', 'plot the gyro’s norm, x, y or z'], ['drag', 'rotate the view; with shift or the right button, move the view'],
  ['wheel, pinch', 'zoom in or out'], ['H', 'show or hide this list']];

const byId = (id) => document.getElementById(id);
function element(name, text, className) {
  const made = document.createElement(name);
  if (text !== undefined) made.textContent = text;
  if (className) made.className = className;
  return made;
}

// Formats a length with at most three digits, for example "2.1 cm".
function lengthText(m) {
  if (m < 0.0995) return `${(100 * m).toFixed(1)} cm`;
  if (m < 9.95) return `${m.toFixed(2)} m`;
  return m < 9999.5 ? `${m.toFixed(0)} m` : `${(m / 1000).toFixed(0)} km`;
}

// Lists truth and methods with their colours and current position errors.
function showActors(replay, changed) {
  const list = byId('actors');
  replay.actors.forEach((actor, i) => {
    const item = element('li'), label = element('label'), box = element('input');
    box.type = 'checkbox';
    box.checked = true;
    box.addEventListener('change', () => { actor.shown = box.checked; changed(); });
    const swatch = element('span', undefined, 'swatch');
    swatch.style.background = actor.css;
    actor.off = element('span', '', 'off');
    actor.box = box;
    label.append(box, swatch, element('span', actor.name, 'name'), actor.off);
    if (i < 9) label.title = `key ${i + 1}`;
    item.append(label);
    list.append(item);
  });
}

function sayErrors(replay, t) {
  const truth = replay.actors.find((actor) => actor.truth && actor.track), there = truth && truth.track.pose(t);
  for (const actor of replay.actors) {
    if (actor.truth) continue;
    if (!actor.track) { actor.off.textContent = 'rate alone'; continue; }
    const pose = actor.track.pose(t);
    actor.off.textContent = pose && there ? `${lengthText(distance(pose.p, there.p))} off` : pose ? '' : 'no pose yet';
  }
}

// The estimate whose points are nearest to the true surface. The truth's cloud would show only sensor noise.
function bestPlacing(replay) {
  const estimates = replay.actors.filter((actor) => actor.track && !actor.truth);
  const off = (actor) => actor.errors ? actor.errors.reduce((sum, error) => sum + error, 0) : 0;
  return estimates.sort((a, b) => off(a) - off(b))[0] || replay.actors.find((actor) => actor.track);
}

// Selects the motion that places the points, and shows the scale of their colours.
function showPlacing(replay, chosen, changed) {
  const can = replay.actors.filter((actor) => actor.track);
  if (!replay.head.points.shown) return;
  byId('pointer').hidden = false;
  const select = byId('placed');
  can.forEach((actor) => {
    const option = element('option', actor.name);
    option.value = String(replay.actors.indexOf(actor));
    option.selected = actor === chosen;
    select.append(option);
  });
  select.addEventListener('change', () => changed(replay.actors[Number(select.value)]));
  showScale(replay, Boolean(chosen.errors));
}

function showScale(replay, byError) {
  const head = replay.head, colours = byError ? head.error_colours : HEIGHT_COLOURS, pen = byId('ramp').getContext('2d');
  for (let x = 0; x < 256; ++x) {
    pen.fillStyle = `rgb(${colours[Math.floor(x / 4)].join()})`;
    pen.fillRect(x, 0, 1, 1);
  }
  const ticks = byError ? ['0', '0.25', '0.5', '0.75', `≥ ${head.error_max_m} m`] : ['low', 'high'];
  byId('ticks').replaceChildren(...ticks.map((tick) => element('span', tick)));
  byId('scale-says').textContent = byError
    ? 'The colour of each lidar point shows its distance to the true surface.'
    : 'The true surface is unknown. The colour of each lidar point shows its height.';
}

// Describes the page in one sentence.
function leadOf(replay) {
  const estimates = replay.actors.filter((actor) => !actor.truth).length;
  if (!replay.actors.some((actor) => actor.truth)) return 'This recording has no truth. The page shows the motions that the methods estimate.';
  return estimates ? 'The page shows the true motion and the motions that the methods estimate from the sensors.' : 'The page shows the true motion and the sensor readings.';
}

function showFacts(replay) {
  const { head } = replay, strip = head.strip, facts = byId('facts');
  const count = (n) => n.toLocaleString('en');
  const say = (text) => facts.append(element('p', text));
  const truth = replay.actors.some((actor) => actor.truth);
  say(truth ? 'Each estimate is aligned with the truth at its start, in position and heading. '
    + 'The solid body is the truth; transparent bodies are estimates.' : 'The recording has no truth. All estimates are aligned with the first one, in position and heading.');
  if (head.points.of) say(`${count(head.points.shown)} of ${count(head.points.of)} lidar returns are shown, spread evenly over sweeps and beams. Returns from the robot itself are left out.`);
  if (head.world.of) say(`${count(head.world.shown)} of ${count(head.world.of)} triangles of the world are shown. The ground is shown in full resolution near the path, and coarser farther away.`);
  if (strip.of) {
    say(`The strip shows ${count(strip.shown)} of ${count(strip.of)} gyro samples${strip.shown < strip.of ? ' (the fastest of each group)' : ''} as a thin line`
      + `${replay.actors.some((actor) => actor.truth && actor.rates) ? ', the true rate as a wide line below it' : ''}, and each method’s rate in its colour. `
      + (strip.clipping ? `In shaded intervals, at least one axis is clipped, according to ${strip.clipping}.` : 'The recording does not state where the gyro is clipped.'));
  }
  if (strip.contacts_known) say('The bars at the bottom show contacts with the world. For a sphere, the bars of slip and slide are higher.');
  for (const [name, value] of head.facts) say(`${name}: ${value}`);
}

function showKeys() {
  const list = element('dl');
  for (const [key, does] of KEYS) list.append(element('dt', key), element('dd', does));
  byId('keys').append(list);
}

// Drag, wheel and touch rotate, move and zoom.
function steerCamera(canvas, camera, changed) {
  const fingers = new Map();
  let apart = 0;
  const spread = () => {
    const [a, b] = [...fingers.values()];
    return { apart: Math.hypot(a.x - b.x, a.y - b.y), x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 };
  };
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (fingers.size === 2) apart = spread().apart;
  });
  canvas.addEventListener('pointermove', (event) => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const middle = fingers.size === 2 ? spread() : null;
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (middle) {
      const now = spread();
      camera.nearer(apart / Math.max(now.apart, 1));
      apart = now.apart;
      camera.turn((now.x - middle.x) / canvas.clientHeight * 3, (now.y - middle.y) / canvas.clientHeight * 3);
    } else if (event.shiftKey || event.buttons === 2) {
      camera.move((event.clientX - before.x) / canvas.clientHeight, (event.clientY - before.y) / canvas.clientHeight);
    } else {
      camera.turn((event.clientX - before.x) / canvas.clientHeight * 4, (event.clientY - before.y) / canvas.clientHeight * 3);
    }
    changed();
  });
  for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, (event) => fingers.delete(event.pointerId));
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    camera.nearer(Math.exp(event.deltaY * (event.deltaMode ? 0.05 : 0.0012)));
    changed();
  }, { passive: false });
}

// Clicking or dragging on the strip selects a time.
function scrubStrip(strip, goTo) {
  const to = (event) => goTo(strip.time(event.clientX - strip.canvas.getBoundingClientRect().left));
  strip.canvas.addEventListener('pointerdown', (event) => { strip.canvas.setPointerCapture(event.pointerId); to(event); });
  strip.canvas.addEventListener('pointermove', (event) => { if (event.buttons) to(event); });
}
