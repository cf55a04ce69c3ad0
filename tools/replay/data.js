// Data of the page: a JSON head and one block of bytes. Positions are in metres from the head's origin, times in
// seconds from the start of the recording.
function readReplay() {
  const head = JSON.parse(document.getElementById('head').textContent);
  const text = atob(document.getElementById('bytes').textContent);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  const kinds = { int16: Int16Array, uint16: Uint16Array, uint32: Uint32Array, uint8: Uint8Array, float32: Float32Array };
  const array = (name) => {
    const at = head.arrays[name];
    return at ? new kinds[at.type](bytes.buffer, at.offset, at.length) : null;
  };
  const actors = head.actors.map((said, i) => Object.assign({}, said, {
    shown: true,
    colour: colourOf(said.colour),
    css: said.colour,
    track: said.moves ? new Track(array(`actor${i}.positions`), array(`actor${i}.attitudes`), head.pose_step_s) : null,
    errors: array(`actor${i}.errors`),
    rates: array(`actor${i}.rates`),
  }));
  return { head, array, actors };
}

// Converts "#rrggbb" to three numbers from 0 to 1.
function colourOf(hex) {
  return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);
}

// Poses of the body at equal steps; an unknown position is not finite.
class Track {
  constructor(positions, attitudes, step_s) {
    this.positions = positions;
    this.attitudes = attitudes;
    this.step_s = step_s;
    this.count = positions.length / 3;
  }
  known(k) { return k >= 0 && k < this.count && Number.isFinite(this.positions[3 * k]); }
  position(k) { return [this.positions[3 * k], this.positions[3 * k + 1], this.positions[3 * k + 2]]; }
  attitude(k) { return [0, 1, 2, 3].map((i) => this.attitudes[4 * k + i] / 32767); }
  // Returns the interpolated pose {p, q}, or null if it is unknown.
  pose(t) {
    const at = t / this.step_s, k = Math.floor(at), share = at - k;
    if (!this.known(k)) return null;
    if (!this.known(k + 1)) return { p: this.position(k), q: this.attitude(k) };
    return { p: mix(this.position(k), this.position(k + 1), share), q: turnBetween(this.attitude(k), this.attitude(k + 1), share) };
  }
  // Index of the first and of the last known pose; null if all are unknown.
  span() {
    let first = 0, last = this.count - 1;
    while (first < this.count && !this.known(first)) ++first;
    while (last > first && !this.known(last)) --last;
    return first < this.count ? [first, last] : null;
  }
}

// Returns the first index of a sorted list whose entry is greater than `value`.
function countUpTo(list, value) {
  let low = 0, high = list.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (list[middle] <= value) low = middle + 1; else high = middle;
  }
  return low;
}
