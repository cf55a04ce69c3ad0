// The ways as bands: two corners a sample, each with the direction ahead, its side and its time.
function ribbonOf(track, least_m) {
  const kept = [];
  for (let k = 0; k < track.count; ++k) {
    if (!track.known(k)) { kept.push(null); continue; }
    const p = track.place(k), last = kept[kept.length - 1];
    if (last && distance(last.p, p) < least_m) continue;
    kept.push({ p, t: k * track.step_s });
  }
  const numbers = [];
  const corner = (one, ahead, side) => numbers.push(...one.p, ...ahead, side, one.t);
  for (let i = 0; i < kept.length; ++i) {
    if (!kept[i]) continue;
    const before = kept[i - 1] || kept[i], after = kept[i + 1] || kept[i];
    const ahead = unit(minus(after.p, before.p));
    // a gap: corners twice, which draw nothing
    if (!kept[i - 1] && numbers.length) numbers.push(...numbers.slice(-8)), corner(kept[i], ahead, -1);
    corner(kept[i], ahead, -1);
    corner(kept[i], ahead, 1);
  }
  return new Float32Array(numbers);
}
