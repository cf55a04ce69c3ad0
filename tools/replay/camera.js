// A camera around a point. The camera follows a robot or stays; the reader can rotate, zoom and move it.
class Camera {
  constructor(target, distance_m, azimuth_rad) {
    this.target = target.slice();
    this.distance_m = distance_m;
    this.azimuth_rad = azimuth_rad;
    this.elevation_rad = 0.42;
    this.follows = true;
    this.drift_rad_s = 0.06;  // until the reader takes over
    this.height_rad = 0.8;
  }
  eye() {
    const flat = Math.cos(this.elevation_rad);
    return add(this.target, times([flat * Math.cos(this.azimuth_rad), flat * Math.sin(this.azimuth_rad),
      Math.sin(this.elevation_rad)], this.distance_m));
  }
  // Follows the robot smoothly; jumps if the time was changed.
  follow(position, elapsed_s) {
    if (!this.follows || !position) return;
    const away = distance(this.target, position);
    this.target = mix(this.target, position, away > 3 * this.distance_m ? 1 : 1 - Math.exp(-elapsed_s * 6));
  }
  drift(elapsed_s) { this.azimuth_rad += this.drift_rad_s * elapsed_s; }
  turn(x_rad, y_rad) {
    this.drift_rad_s = 0;
    this.azimuth_rad -= x_rad;
    this.elevation_rad = Math.min(1.5, Math.max(-0.2, this.elevation_rad + y_rad));
  }
  nearer(factor) { this.distance_m = Math.min(200, Math.max(0.4, this.distance_m * factor)); }
  // Moves by shares of the picture's height, and stops following the robot.
  move(right, up) {
    this.drift_rad_s = 0;
    const back = unit(minus(this.eye(), this.target)), side = unit(cross([0, 0, 1], back)), above = cross(back, side);
    const size_m = 2 * this.distance_m * Math.tan(this.height_rad / 2);
    this.target = add(this.target, add(times(side, -right * size_m), times(above, up * size_m)));
    this.follows = false;
  }
  // `beside`: share of the width at the left that the panel covers.
  matrices(aspect, beside) {
    const eye = this.eye();
    const view = lookingAt(eye, this.target, [0, 0, 1]);
    // in a portrait picture the horizontal field of view is kept
    const height_rad = aspect < 1 ? 2 * Math.atan(Math.tan(this.height_rad / 2) / Math.max(aspect, 0.55)) : this.height_rad;
    const projection = perspective(height_rad, aspect, Math.max(0.05, this.distance_m / 60), 400);
    projection[8] = -beside;
    return { eye, view, projection, both: product(projection, view), height_rad };
  }
}

// Initial view across the path, so that slopes are visible.
function firstCamera(replay) {
  const moving = replay.actors.find((actor) => actor.track && actor.track.span());
  const [first, last] = moving.track.span();
  const from = moving.track.position(first), to = moving.track.position(last), moved = minus(to, from);
  const azimuth = Math.hypot(moved[0], moved[1]) < 0.2 ? -1.2 : Math.atan2(moved[1], moved[0]) - 1.15;
  const distance_m = Math.max(2.2, 10 * replay.head.robot_radius_m);
  return new Camera(moving.track.position(Math.min(last, Math.max(first, Math.round(replay.head.from_s / replay.head.pose_step_s)))),
    distance_m, azimuth);
}
