// The gyro over time: lines, clipped intervals, contacts and a cursor.
const CONTACTS = { contact: ['--contact', 1], slip: ['--slip', 1], slide: ['--slide', 1] };

class Strip {
  constructor(canvas, replay) {
    this.canvas = canvas;
    this.replay = replay;
    this.axis = 'norm';
    this.times = replay.array('strip.times') || new Uint32Array(0);
    this.gyro = replay.array('strip.gyro') || new Int16Array(0);
    this.clipped = replay.array('strip.clipped') || new Uint8Array(0);
    this.still = document.createElement('canvas');
  }
  // Rate at sample k [rad/s]; NaN if unknown.
  rate(rates, k) {
    const scale = this.replay.head.strip.scale_rad_s;
    if (rates[3 * k] === -32768) return NaN;
    if (this.axis === 'norm') return scale * Math.hypot(rates[3 * k], rates[3 * k + 1], rates[3 * k + 2]);
    return scale * rates[3 * k + 'xyz'.indexOf(this.axis)];
  }
  isClipped(k) {
    return this.axis === 'norm' ? this.clipped[k] !== 0 : Boolean(this.clipped[k] >> 'xyz'.indexOf(this.axis) & 1);
  }
  // State at an instant: the gyro's norm, and whether any axis is clipped.
  at(t) {
    const k = countUpTo(this.times, t * 1e6) - 1;
    if (k < 0) return null;
    const scale = this.replay.head.strip.scale_rad_s;
    return { rate: scale * Math.hypot(this.gyro[3 * k], this.gyro[3 * k + 1], this.gyro[3 * k + 2]), clipped: this.clipped[k] !== 0 };
  }
  x(t) { return this.left + t / this.replay.head.end_s * (this.width - this.left - 8); }
  time(x) {
    const share = (x - this.left) / (this.width - this.left - 8);
    return Math.min(1, Math.max(0, share)) * this.replay.head.end_s;
  }

  // Draws everything but the cursor; repeated if size, colours or visible methods change.
  prepare() {
    const ratio = window.devicePixelRatio || 1;
    this.width = this.canvas.clientWidth;
    this.height = this.canvas.clientHeight;
    this.left = 44;
    for (const canvas of [this.canvas, this.still])
      Object.assign(canvas, { width: Math.round(this.width * ratio), height: Math.round(this.height * ratio) });
    this.ratio = ratio;
    const pen = this.still.getContext('2d');
    const style = getComputedStyle(document.documentElement);
    this.colour = (name) => style.getPropertyValue(name).trim();
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, this.width, this.height);
    pen.font = `11px ${getComputedStyle(document.body).fontFamily}`;
    this.bottom = this.height - 16;
    this.plotBottom = this.bottom - (this.replay.head.strip.contacts_known ? 11 : 2);
    this.findRange();
    this.drawClipped(pen);
    this.drawAxes(pen);
    this.drawContacts(pen);
    this.drawLines(pen);
  }
  findRange() {
    let high = 1, low = 0;
    const look = (rates) => {
      for (let k = 0; k < this.times.length; ++k) {
        const rate = this.rate(rates, k);
        if (rate > high) high = rate;
        if (rate < low) low = rate;
      }
    };
    look(this.gyro);
    for (const actor of this.replay.actors) if (actor.truth && actor.rates) look(actor.rates);
    this.high = 1.08 * high;
    this.low = 1.08 * low;
  }
  y(rate) {
    return Math.min(this.plotBottom, Math.max(2, this.plotBottom - (rate - this.low) / (this.high - this.low) * (this.plotBottom - 4)));
  }
  drawClipped(pen) {
    pen.fillStyle = this.colour('--clipped');
    pen.globalAlpha = 0.3;
    for (let k = 0; k < this.times.length; ++k) {
      if (!this.isClipped(k)) continue;
      const first = k;
      while (k + 1 < this.times.length && this.isClipped(k + 1)) ++k;
      const from = this.x(this.times[Math.max(0, first - 1)] * 1e-6), to = this.x(this.times[k] * 1e-6);
      pen.fillRect(from, 2, Math.max(1, to - from), this.plotBottom - 2);
    }
    pen.globalAlpha = 1;
  }
  drawAxes(pen) {
    pen.fillStyle = this.colour('--soft');
    pen.strokeStyle = this.colour('--rule');
    pen.textBaseline = 'middle';
    pen.textAlign = 'right';
    const step = niceStep((this.high - this.low) / 3);
    for (let rate = Math.ceil(this.low / step) * step; rate <= this.high; rate += step) {
      const y = this.y(rate);
      line(pen, this.left, y, this.width - 8, y);
      if (y > 8) pen.fillText(String(Math.round(rate * 100) / 100), this.left - 5, y);
    }
    pen.save();
    pen.translate(9, this.plotBottom / 2);
    pen.rotate(-Math.PI / 2);
    pen.textAlign = 'center';
    pen.fillText('rad/s', 0, 0);
    pen.restore();
    pen.textBaseline = 'top';
    pen.textAlign = 'center';
    const seconds = niceStep(this.replay.head.end_s / Math.max(3, this.width / 110));
    for (let t = 0; t <= this.replay.head.end_s; t += seconds)
      pen.fillText(`${Math.round(t * 1000) / 1000} s`, Math.min(this.x(t), this.width - 20), this.bottom + 3);
  }
  drawContacts(pen) {
    if (!this.replay.head.strip.contacts_known) return;
    for (const [from, to, name] of this.replay.head.strip.contacts) {
      pen.fillStyle = this.colour((CONTACTS[name] || CONTACTS.contact)[0]);
      const high = name === 'contact' ? 4 : 8;  // slip and slide stand out without their colour, too
      pen.fillRect(this.x(from), this.bottom - high, Math.max(0.75, this.x(to) - this.x(from)), high);
    }
  }
  drawLines(pen) {
    const shown = this.replay.actors.filter((actor) => actor.rates && actor.shown);
    for (const actor of shown.filter((one) => one.truth)) this.drawLine(pen, actor.rates, actor.css, 3.2);
    for (const actor of shown.filter((one) => !one.truth)) this.drawLine(pen, actor.rates, actor.css, 1.8);
    this.drawLine(pen, this.gyro, this.colour('--gyro'), 1.1);
  }
  drawLine(pen, rates, colour, width) {
    pen.strokeStyle = colour;
    pen.lineWidth = width;
    pen.lineJoin = 'round';
    pen.beginPath();
    let down = false;
    for (let k = 0; k < this.times.length; ++k) {
      const rate = this.rate(rates, k);
      if (Number.isNaN(rate)) { down = false; continue; }
      const x = this.x(this.times[k] * 1e-6), y = this.y(rate);
      if (down) pen.lineTo(x, y); else pen.moveTo(x, y);
      down = true;
    }
    pen.stroke();
  }

  draw(t) {
    const pen = this.canvas.getContext('2d');
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
    pen.drawImage(this.still, 0, 0);
    pen.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    const x = this.x(t);
    pen.fillStyle = this.colour('--ground');
    pen.globalAlpha = 0.55;
    pen.fillRect(x, 0, this.width - x, this.plotBottom);
    pen.globalAlpha = 1;
    pen.strokeStyle = this.colour('--accent');
    pen.lineWidth = 2;
    line(pen, x, 0, x, this.bottom);
    pen.fillStyle = this.colour('--accent');
    pen.beginPath();
    pen.arc(x, 4, 4, 0, 7);
    pen.fill();
  }
}

function line(pen, x0, y0, x1, y1) {
  pen.beginPath();
  pen.moveTo(x0, y0);
  pen.lineTo(x1, y1);
  pen.stroke();
}

// Returns 1, 2 or 5 times a power of ten, at least `least`.
function niceStep(least) {
  const power = 10 ** Math.floor(Math.log10(Math.max(least, 1e-9)));
  return [1, 2, 5, 10].map((m) => m * power).find((step) => step >= least * 0.999);
}
