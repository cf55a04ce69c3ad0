// Paths as bands: two corners per sample, each with the forward direction, its side and its time.
// A path ends where it leaves `box`; otherwise a diverged path would cross the whole picture.
function ribbonOf(track, least_m, box) {
  const kept = [];
  for (let k = 0; k < track.count; ++k) {
    if (!track.known(k)) { kept.push(null); continue; }
    const p = track.position(k);
    if (p.some((value, i) => value < box.low[i] || value > box.high[i])) break;
    const last = kept[kept.length - 1];
    if (last && distance(last.p, p) < least_m) continue;
    kept.push({ p, t: k * track.step_s });
  }
  const numbers = [];
  const corner = (one, ahead, side) => numbers.push(...one.p, ...ahead, side, one.t);
  for (let i = 0; i < kept.length; ++i) {
    if (!kept[i]) continue;
    const before = kept[i - 1] || kept[i], after = kept[i + 1] || kept[i];
    const ahead = unit(minus(after.p, before.p));
    // a gap: repeated corners draw nothing
    if (!kept[i - 1] && numbers.length) numbers.push(...numbers.slice(-8)), corner(kept[i], ahead, -1);
    corner(kept[i], ahead, -1);
    corner(kept[i], ahead, 1);
  }
  return new Float32Array(numbers);
}

// Bounding box of the first path, widened on each side by half of its diagonal and at least 1 m.
function surroundings(replay) {
  const { low, high } = boxOf(replay.actors.find((actor) => actor.track && actor.track.span()).track);
  const margin = Math.max(1, 0.5 * distance(low, high));
  return { low: low.map((value) => value - margin), high: high.map((value) => value + margin) };
}

function boxOf(track) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let k = 0; k < track.count; ++k) {
    if (!track.known(k)) continue;
    track.position(k).forEach((value, i) => { low[i] = Math.min(low[i], value); high[i] = Math.max(high[i], value); });
  }
  return { low, high };
}
