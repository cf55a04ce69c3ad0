// Combines the parts of the page and advances the time.
class Player {
  constructor(replay) {
    this.replay = replay;
    this.head = replay.head;
    this.strip = new Strip(byId('strip'), replay);
    this.camera = firstCamera(replay);
    this.stage = null;
    this.placed = bestPlacing(replay);
    this.begin_s = Math.max(0, this.head.from_s - 0.4);
    this.end_s = Math.min(this.head.end_s, this.head.to_s + 0.8);
    this.t = this.begin_s;
    this.speed = this.end_s - this.begin_s < 4 ? 0.5 : 1;
    this.playing = !matchMedia('(prefers-reduced-motion: reduce)').matches;
    if (!this.playing) this.t = 0.5 * (this.head.from_s + this.head.to_s);
    this.rest_s = 0;
    this.stale = true;
    this.movedAt = -1e9;
    this.slow = 0;
    this.frames = 0;
  }

  begin() {
    document.title = byId('title').textContent = this.head.title;
    byId('lead').textContent = leadOf(this.replay);
    showActors(this.replay, () => this.redrawStrip());
    if (this.placed) showPlacing(this.replay, this.placed, (actor) => this.place(actor));
    showFacts(this.replay);
    showKeys();
    this.connect();
    this.readAddress();
    try {
      this.stage = new Stage(byId('scene'), this.replay);
    } catch (error) {
      this.trouble(error);
    }
    this.redrawStrip();
    this.setSpeed(this.speed);
    this.setPlaying(this.playing);
    requestAnimationFrame((now) => this.frame(now));
  }

  // The strip and the texts work without the picture.
  trouble(error) {
    const says = byId('trouble');
    says.textContent = error.message;
    says.hidden = false;
    document.documentElement.dataset.state = 'failed';
    console.error(error.message);
  }

  connect() {
    const again = () => { this.stale = true; };
    steerCamera(byId('scene'), this.camera, () => this.moved());
    scrubStrip(this.strip, (t) => this.goTo(t));
    byId('play').addEventListener('click', () => this.setPlaying(!this.playing));
    byId('camera').addEventListener('click', () => this.setFollowing(!this.camera.follows));
    byId('help').addEventListener('click', () => this.toggleKeys());
    byId('fold').addEventListener('click', () => this.fold(byId('about').hidden));
    for (const speed of SPEEDS) byId('speed').append(Object.assign(element('option', `${speed} ×`), { value: speed }));
    byId('speed').addEventListener('change', () => this.setSpeed(Number(byId('speed').value)));
    for (const axis of ['norm', 'x', 'y', 'z']) byId('axis').append(Object.assign(element('option', axis), { value: axis }));
    byId('axis').addEventListener('change', () => this.setAxis(byId('axis').value));
    byId('scrub').max = this.head.end_s;
    byId('scrub').addEventListener('input', () => this.goTo(Number(byId('scrub').value)));
    document.addEventListener('keydown', (event) => this.key(event));
    new ResizeObserver(() => this.redrawStrip()).observe(byId('strip'));
    new ResizeObserver(again).observe(byId('scene'));
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
      if (this.stage) this.stage.readTheme();
      this.redrawStrip();
    });
    if (matchMedia('(max-width: 640px)').matches) this.fold(false);
  }

  // FILE.html#t=3.2&pause&whole selects the start, for links and pictures.
  readAddress() {
    const wanted = new URLSearchParams(location.hash.slice(1)), t = parseFloat(wanted.get('t'));
    if (Number.isFinite(t)) this.t = Math.min(this.head.end_s, Math.max(0, t));
    if (wanted.has('pause')) this.playing = false;
    if (wanted.has('still')) this.camera.drift_rad_s = 0;
    const robot = this.followed();
    if (robot) this.camera.follow(robot.p, 100);
    if (wanted.has('whole')) this.setFollowing(false);
    const by = this.replay.actors.find((actor) => actor.track && actor.name === wanted.get('by'));
    if (by) this.place(by);
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || /^(SELECT|INPUT)$/.test(event.target.tagName) && event.target.type !== 'checkbox') return;
    const step = event.shiftKey ? 1 : 0.1, speeds = SPEEDS.indexOf(this.speed), key = event.key.toLowerCase();
    const moving = this.replay.actors.filter((actor) => actor.track);
    const does = {
      ' ': () => this.setPlaying(!this.playing), arrowleft: () => this.goTo(this.t - step), arrowright: () => this.goTo(this.t + step),
      home: () => this.goTo(0), end: () => this.goTo(this.head.end_s),
      '+': () => this.setSpeed(SPEEDS[Math.min(SPEEDS.length - 1, speeds + 1)]), '-': () => this.setSpeed(SPEEDS[Math.max(0, speeds - 1)]),
      f: () => this.setFollowing(!this.camera.follows), h: () => this.toggleKeys(),
      p: () => this.place(moving[(moving.indexOf(this.placed) + 1) % moving.length]),
      g: () => this.setAxis({ norm: 'x', x: 'y', y: 'z', z: 'norm' }[this.strip.axis]),
    };
    if (/^[1-9]$/.test(key) && this.replay.actors[key - 1]) does[key] = () => this.replay.actors[key - 1].box.click();
    // a focused button uses the space bar itself
    if (!does[key] || (key === ' ' && /^(BUTTON|SUMMARY)$/.test(event.target.tagName))) return;
    event.preventDefault();
    does[key]();
  }

  place(actor) {
    if (!actor) return;
    this.placed = actor;
    byId('placed').value = String(this.replay.actors.indexOf(actor));
    if (this.head.points.shown) showScale(this.replay, Boolean(actor.errors));
    this.stale = true;
  }
  goTo(t) {
    this.t = Math.min(this.head.end_s, Math.max(0, t));
    if (this.t < this.begin_s || this.t > this.end_s) { this.begin_s = 0; this.end_s = this.head.end_s; }
    this.rest_s = 0;
    this.moved();
    this.say();
  }
  // Renders several quick pictures after a change, then one of full quality.
  moved() {
    this.movedAt = performance.now();
    this.stale = true;
  }
  setPlaying(playing) {
    this.playing = playing;
    byId('play').textContent = playing ? '❚❚' : '▶';
    byId('play').setAttribute('aria-label', playing ? 'pause' : 'play');
    this.stale = true;
  }
  setSpeed(speed) {
    this.speed = speed;
    byId('speed').value = String(speed);
  }
  setAxis(axis) {
    this.strip.axis = byId('axis').value = axis;
    this.redrawStrip();
  }
  setFollowing(follows) {
    this.camera.follows = follows;
    byId('camera').textContent = follows ? 'follow' : 'whole';
    const near_m = Math.max(2.2, 10 * this.head.robot_radius_m);
    if (follows) {
      this.camera.distance_m = near_m;
    } else {
      const { middle, size_m } = this.wholeWay();
      this.camera.target = middle;
      this.camera.distance_m = Math.max(near_m, 1.25 * size_m);
    }
    this.stale = true;
  }
  toggleKeys() {
    byId('keys').hidden = !byId('keys').hidden;
    byId('help').setAttribute('aria-expanded', String(!byId('keys').hidden));
  }
  fold(open) {
    byId('about').hidden = !open;
    byId('fold').setAttribute('aria-expanded', String(open));
  }
  redrawStrip() {
    this.strip.prepare();
    this.strip.draw(this.t);  // at once: a canvas of another size is empty
    this.stale = true;
  }

  // Pose that the camera follows: the truth, or else the first visible estimate.
  followed() {
    for (const actor of this.replay.actors) {
      const pose = actor.track && (actor.shown || actor.truth) && actor.track.pose(this.t);
      if (pose) return pose;
    }
    return null;
  }
  wholeWay() {
    const { low, high } = boxOf(this.replay.actors.find((actor) => actor.track && actor.track.span()).track);
    return { middle: mix(low, high, 0.5), size_m: distance(low, high) };
  }

  pass(elapsed_s) {
    if (!this.playing) return;
    this.stale = true;
    if (this.t >= this.end_s) {
      this.rest_s += elapsed_s;
      if (this.rest_s > 1.5) { this.t = this.begin_s; this.rest_s = 0; }
      return;
    }
    this.t = Math.min(this.end_s, this.t + this.speed * elapsed_s);
  }

  frame(now) {
    const elapsed_s = Math.min(0.2, (now - (this.before || now)) / 1000);
    this.before = now;
    this.pass(elapsed_s);
    const robot = this.followed();
    if (this.playing) this.camera.drift(elapsed_s);
    if (robot) this.camera.follow(robot.p, elapsed_s);
    const following = Boolean(robot) && this.camera.follows && distance(this.camera.target, robot.p) > 1e-3;
    const moving = this.playing || following || now - this.movedAt < 250;
    if (this.stale) this.draw(moving);
    this.stale = moving;
    requestAnimationFrame((next) => this.frame(next));
  }

  draw(moving) {
    const root = document.documentElement;
    if (this.stage) {
      try {
        this.stage.draw(this.t, this.camera, this.placed, moving);
        // slow rendering without a graphics card: reduce the quality
        if (this.playing && ++this.frames < 40) this.watch();
        root.dataset.state = 'drawn';
        root.dataset.moving = String(moving);
        root.dataset.points = String(this.stage.drawn.points);
      } catch (error) {
        this.stage = null;
        this.trouble(error);
      }
    }
    this.strip.draw(this.t);
    this.say();
  }
  watch() {
    const gl = this.stage.gl, began = performance.now(), dot = new Uint8Array(4);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, dot);  // waits until the frame is there
    this.slow = performance.now() - began > 40 ? this.slow + 1 : 0;
    if (this.slow > 2) { this.stage.easier(); this.slow = 0; }
  }

  say() {
    const at = this.strip.at(this.t);
    byId('clock').textContent = `${this.t.toFixed(2)} s`;
    byId('turning').textContent = at ? `${at.rate.toFixed(1)} rad/s by the gyro` : '';
    byId('state').textContent = at && at.clipped ? 'gyro clipped' : '';
    byId('state').className = at && at.clipped ? 'clipped' : '';
    byId('scrub').value = String(this.t);
    sayErrors(this.replay, this.t);
  }
}

new Player(readReplay()).begin();
