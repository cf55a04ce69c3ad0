// Draws one instant of a replay.
const SUN = unit([-0.45, -0.35, 0.82]);

class Stage {
  constructor(canvas, replay) {
    const software = drawsInSoftware();
    const gl = canvas.getContext('webgl2', { antialias: !software, alpha: false, powerPreference: 'high-performance' });
    if (!gl) throw new Error('this browser does not support WebGL 2, which the picture needs; use another browser');
    this.gl = gl;
    this.canvas = canvas;
    this.replay = replay;
    // a still picture may take longer; without a graphics card, supersampling smooths its edges
    this.still = { shadows: true, sharpness: software ? 1.6 : 1, pointStep: 1 };
    this.moving = { shadows: true, sharpness: 1, pointStep: 1 };  // sharpness: resolution relative to the screen's; pointStep: draws every n-th point
    this.eased = 0;
    this.shadowSide = 2048;
    this.drawn = {};
    for (const name of Object.keys(SHADERS)) this[name] = compiled(gl, name);
    const { head, array } = replay;
    this.world = this.bodyOf(head.world.parts.length ? meshOf(head.world, array('world.vertices'), array('world.corners'))
      : emptyGround(boxOf(replay.actors.find((actor) => actor.track && actor.track.span()).track).low[2] - head.robot_radius_m, 40));
    this.showsWorld = head.world.parts.length > 0 || !head.points.shown;  // without parts of the world, the points show the surroundings
    this.robot = this.bodyOf(meshOf(head.robot, array('robot.vertices'), array('robot.corners')));
    this.makePoints(array('points.positions'), array('points.times'));
    for (const actor of replay.actors) this.makeActor(actor);
    this.makeShadowMap();
    this.readTheme();
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    if (gl.getError() !== gl.NO_ERROR) throw new Error('WebGL rejects the data of this page');
    if (software) this.easier();
  }

  buffer(data, target = this.gl.ARRAY_BUFFER) {
    const buffer = this.gl.createBuffer();
    this.gl.bindBuffer(target, buffer);
    this.gl.bufferData(target, data, this.gl.STATIC_DRAW);
    return buffer;
  }

  bodyOf(mesh) {
    const gl = this.gl, list = gl.createVertexArray();
    gl.bindVertexArray(list);
    const attribute = (location, data, size, type, normalised) => {
      this.buffer(data);
      gl.enableVertexAttribArray(location);
      gl.vertexAttribPointer(location, size, type, normalised, 0, 0);
    };
    attribute(0, mesh.positions, 3, gl.FLOAT, false);
    attribute(1, mesh.normals, 3, gl.FLOAT, false);
    attribute(2, mesh.colours, 4, gl.UNSIGNED_BYTE, true);
    this.buffer(mesh.indices, gl.ELEMENT_ARRAY_BUFFER);
    gl.bindVertexArray(null);
    return { list, ranges: joined(mesh.ranges) };
  }

  makePoints(positions, times) {
    const gl = this.gl;
    this.times = times || new Uint32Array(0);
    if (!this.times.length) return;
    this.cloud = gl.createVertexArray();
    gl.bindVertexArray(this.cloud);
    this.positionBuffer = this.buffer(positions);
    this.timeBuffer = this.buffer(this.times);
    gl.bindVertexArray(null);
    this.errorColours = this.texture(64, 1, gl.RGBA8, gl.UNSIGNED_BYTE, new Uint8Array(this.replay.head.error_colours.flatMap((c) => [...c, 255])));
    this.heightColours = this.texture(64, 1, gl.RGBA8, gl.UNSIGNED_BYTE, new Uint8Array(HEIGHT_COLOURS.flatMap((c) => [...c, 255])));
  }

  texture(width, height, format, type, data, filter = this.gl.LINEAR) {
    const gl = this.gl, texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, format, width, height, 0, gl.RGBA, type, data);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, filter);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, filter);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    return texture;
  }

  makeActor(actor) {
    if (!actor.track) return;
    const gl = this.gl;
    const numbers = ribbonOf(actor.track, 0.02 * this.replay.head.robot_radius_m, surroundings(this.replay));
    actor.ribbon = gl.createVertexArray();
    actor.ribbonCount = numbers.length / 8;
    gl.bindVertexArray(actor.ribbon);
    this.buffer(numbers);
    [[3, 0], [3, 12], [2, 24]].forEach(([size, offset], location) => {
      gl.enableVertexAttribArray(location);
      gl.vertexAttribPointer(location, size, gl.FLOAT, false, 32, offset);
    });
    if (actor.errors) {
      actor.errorBuffer = this.buffer(actor.errors);
    }
    gl.bindVertexArray(null);
    if (!this.times.length) return;
    const track = actor.track, rows = Math.ceil(2 * track.count / 1024), texels = new Float32Array(4 * 1024 * rows);
    for (let k = 0; k < track.count; ++k) {
      const known = track.known(k);
      texels.set(known ? [...track.position(k), 1] : [0, 0, 0, 0], 8 * k);
      texels.set(known ? track.attitude(k) : [0, 0, 0, 1], 8 * k + 4);
    }
    actor.heights = heightsOf(actor, this.replay);
    actor.poses = this.texture(1024, rows, gl.RGBA32F, gl.FLOAT, texels, gl.NEAREST);
  }

  makeShadowMap() {
    const gl = this.gl, side = this.shadowSide;
    this.depths = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, this.depths);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, side, side);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    this.shadowBuffer = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadowBuffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.depths, 0);
    gl.drawBuffers([gl.NONE]);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  // The colours of the page, light or dark.
  readTheme() {
    const style = getComputedStyle(document.documentElement);
    const value = (name) => style.getPropertyValue(name).trim();
    this.high = colourOf(value('--sky-high'));
    this.low = colourOf(value('--sky-low'));
    this.light = Number(value('--light'));
  }

  resize() {
    const ratio = Math.min(window.devicePixelRatio || 1, 2) * this.effort.sharpness;
    const width = Math.max(1, Math.round(this.canvas.clientWidth * ratio));
    const height = Math.max(1, Math.round(this.canvas.clientHeight * ratio));
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    this.ratio = ratio;
    // the area below the panel counts as outside of the picture
    const panel = document.getElementById('panel');
    this.beside = this.canvas.clientWidth > 760 ? panel.offsetWidth / this.canvas.clientWidth : 0;
  }

  // On a slow processor, reduces the quality step by step: shadows, resolution, number of points.
  easier() {
    const steps = [{ shadows: false }, { sharpness: 0.75 }, { pointStep: 2 }, { sharpness: 0.6, pointStep: 4 }];
    if (this.eased < steps.length) Object.assign(this.moving, steps[this.eased++]);
  }

  // Robots with a known pose at this time, the truth first.
  robotsAt(t) {
    return this.replay.actors.filter((actor) => actor.track && actor.shown)
      .map((actor) => ({ actor, pose: actor.track.pose(t) }))
      .filter((one) => one.pose)
      .map((one) => Object.assign(one, { body: poseMatrix(one.pose.p, one.pose.q) }));
  }

  draw(t, camera, placed, moving) {
    const gl = this.gl;
    this.effort = moving ? this.moving : this.still;
    this.resize();
    const eye = camera.matrices(this.canvas.width / this.canvas.height, this.beside), robots = this.robotsAt(t);
    const shadow = this.drawShadows(camera, robots);
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.disable(gl.BLEND);
    this.drawSky(camera);
    this.beginSolids(eye, camera, shadow);
    if (this.showsWorld) this.drawWorld(camera);
    this.drawOpaqueRobots(robots);
    this.drawPoints(t, eye, placed);
    this.drawRibbons(t, eye);
    this.drawGhosts(eye, camera, shadow, robots);
    gl.bindVertexArray(null);
  }

  drawShadows(camera, robots) {
    const gl = this.gl, half = Math.min(14, 1.6 * camera.distance_m + 2);
    const light = lookingAt(add(camera.target, times(SUN, 1)), camera.target, [0, 0, 1]);
    const matrix = product(parallel(half, 3 * half), light);
    if (!this.effort.shadows) return matrix;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadowBuffer);
    gl.viewport(0, 0, this.shadowSide, this.shadowSide);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.useProgram(this.shadow.program);
    gl.uniformMatrix4fv(this.shadow.at.u_camera, false, matrix);
    gl.uniformMatrix4fv(this.shadow.at.u_body, false, IDENTITY);
    this.drawRanges(this.world, (range) => !range.clear);
    for (const { actor, body } of robots.slice(0, 4)) {
      if (!actor.truth && robots[0].actor.truth) continue;  // a transparent robot has no shadow
      gl.uniformMatrix4fv(this.shadow.at.u_body, false, body);
      this.drawRanges(this.robot, () => true);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    return matrix;
  }

  drawRanges(body, wanted) {
    const gl = this.gl;
    gl.bindVertexArray(body.list);
    for (const range of body.ranges) {
      if (wanted(range)) gl.drawElements(gl.TRIANGLES, range.count, gl.UNSIGNED_INT, 4 * range.begin);
    }
  }

  drawSky(camera) {
    const gl = this.gl, sky = this.sky;
    gl.depthMask(false);
    gl.useProgram(sky.program);
    gl.uniform3fv(sky.at.u_high, this.high);
    gl.uniform3fv(sky.at.u_low, this.low);
    gl.uniform1f(sky.at.u_horizon, Math.tan(camera.elevation_rad) / Math.tan(camera.height_rad / 2));
    gl.bindVertexArray(null);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.depthMask(true);
  }

  beginSolids(eye, camera, shadow) {
    const gl = this.gl, { program, at } = this.solid;
    gl.useProgram(program);
    gl.uniformMatrix4fv(at.u_camera, false, eye.both);
    gl.uniformMatrix4fv(at.u_body, false, IDENTITY);
    gl.uniformMatrix4fv(at.u_shadow, false, shadow);
    gl.uniform3fv(at.u_eye, eye.eye);
    gl.uniform3fv(at.u_target, camera.target);
    gl.uniform3fv(at.u_haze, this.low);
    gl.uniform1f(at.u_haze_m, 45 + 2 * camera.distance_m);
    gl.uniform3fv(at.u_sun, SUN);
    gl.uniform1f(at.u_light, this.light);
    gl.uniform1f(at.u_shadows, this.effort.shadows ? 1 : 0);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.depths);
    gl.uniform1i(at.u_depths, 0);
  }

  drawWorld(camera) {
    const gl = this.gl, { at } = this.solid;
    gl.uniform4f(at.u_tint, 0, 0, 0, 0);
    gl.uniform1f(at.u_opacity, 1);
    gl.enable(gl.CULL_FACE);
    // the ground is cut only along the line of sight, other objects more widely
    gl.uniform1f(at.u_cut_m, this.replay.head.robot_radius_m);
    gl.uniform1f(at.u_grid, 1);
    this.drawRanges(this.world, (range) => range.ground);
    gl.uniform1f(at.u_cut_m, Math.max(0.18 * camera.distance_m, 1.5 * this.replay.head.robot_radius_m));
    gl.uniform1f(at.u_grid, 0);
    this.drawRanges(this.world, (range) => !range.ground && !range.clear);
    gl.disable(gl.CULL_FACE);
  }

  // The robot of the truth, or else of the first estimate, in the robot's own colours.
  drawOpaqueRobots(robots) {
    const gl = this.gl, { at } = this.solid;
    gl.uniform1f(at.u_cut_m, 0);
    const solid = robots.filter((one) => one.actor.truth || !this.replay.actors[0].truth);
    for (const one of solid) {
      gl.uniformMatrix4fv(at.u_body, false, one.body);
      gl.uniform4f(at.u_tint, ...one.actor.colour, one.actor.truth ? 0.22 : 0.55);
      this.drawRanges(this.robot, (range) => !range.clear);
    }
  }

  // Estimates next to the truth, and transparent shells.
  drawGhosts(eye, camera, shadow, robots) {
    const gl = this.gl, { at } = this.solid;
    this.beginSolids(eye, camera, shadow);
    gl.uniform1f(at.u_cut_m, 0);
    gl.uniform1f(at.u_grid, 0);
    gl.enable(gl.BLEND);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE);
    gl.enable(gl.CULL_FACE);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(-1, -1);
    const withTruth = this.replay.actors[0].truth;
    for (const one of robots) {
      const ghost = withTruth && !one.actor.truth;
      gl.uniformMatrix4fv(at.u_body, false, one.body);
      gl.uniform4f(at.u_tint, ...one.actor.colour, ghost ? 0.85 : 0.3);
      gl.uniform1f(at.u_opacity, ghost ? 0.62 : 1);
      this.drawRanges(this.robot, (range) => ghost || range.clear);
    }
    gl.disable(gl.POLYGON_OFFSET_FILL);
    gl.disable(gl.CULL_FACE);
    gl.disable(gl.BLEND);
  }

  drawRibbons(t, eye) {
    const gl = this.gl, { program, at } = this.ribbon;
    gl.useProgram(program);
    gl.uniformMatrix4fv(at.u_camera, false, eye.both);
    gl.uniform3fv(at.u_eye, eye.eye);
    gl.uniform1f(at.u_now, t);
    gl.uniform1f(at.u_pixel, this.ratio * Math.tan(eye.height_rad / 2) / this.canvas.height);
    gl.enable(gl.BLEND);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE);
    gl.depthMask(false);
    const width_m = 0.075 * this.replay.head.robot_radius_m;
    // the true path is slightly wider, so that it is visible behind an estimate; hidden parts are drawn faintly
    for (const [test, opacity] of [[gl.GREATER, 0.22], [gl.LEQUAL, 0.95]]) {
      gl.depthFunc(test);
      for (const actor of this.replay.actors) {
        if (!actor.ribbon || !actor.shown) continue;
        gl.uniform3fv(at.u_colour, actor.colour);
        gl.uniform1f(at.u_opacity, opacity);
        gl.uniform1f(at.u_width_m, actor.truth ? 1.9 * width_m : width_m);
        gl.bindVertexArray(actor.ribbon);
        gl.drawArrays(gl.TRIANGLE_STRIP, 0, actor.ribbonCount);
      }
    }
    gl.depthFunc(gl.LEQUAL);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }

  drawPoints(t, eye, placed) {
    this.drawn.points = 0;
    if (!placed || !placed.poses || !this.times.length) return;
    const gl = this.gl, { program, at } = this.points, head = this.replay.head;
    gl.useProgram(program);
    const step = this.effort.pointStep;
    gl.bindVertexArray(this.cloud);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.positionBuffer);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.SHORT, false, 6 * step, 0);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.timeBuffer);
    gl.enableVertexAttribArray(1);
    gl.vertexAttribIPointer(1, 1, gl.UNSIGNED_INT, 4 * step, 0);
    if (placed.errorBuffer) {
      gl.bindBuffer(gl.ARRAY_BUFFER, placed.errorBuffer);
      gl.enableVertexAttribArray(2);
      gl.vertexAttribPointer(2, 1, gl.UNSIGNED_BYTE, false, step, 0);
    } else {
      gl.disableVertexAttribArray(2);
    }
    gl.uniformMatrix4fv(at.u_camera, false, eye.both);
    gl.uniformMatrix4fv(at.u_mount, false, placed.mount);
    gl.uniform3fv(at.u_eye, eye.eye);
    gl.uniform1ui(at.u_step_us, Math.round(head.pose_step_s * 1e6));
    gl.uniform1ui(at.u_last, placed.track.count - 1);
    gl.uniform1f(at.u_scale_m, head.points.scale_m);
    gl.uniform1f(at.u_now_us, t * 1e6);
    gl.uniform1f(at.u_largest, 6 * this.ratio);
    gl.uniform1f(at.u_size, 0.022 * Math.min(this.canvas.height, 1.2 * this.canvas.width));
    gl.uniform1f(at.u_by_error, placed.errorBuffer ? 1 : 0);
    gl.uniform1f(at.u_glow, 0.85);
    gl.uniform2f(at.u_heights, ...placed.heights);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, placed.poses);
    gl.uniform1i(at.u_poses, 0);
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, placed.errorBuffer ? this.errorColours : this.heightColours);
    gl.uniform1i(at.u_colours, 1);
    this.drawn.points = Math.floor(countUpTo(this.times, t * 1e6) / step);
    gl.drawArrays(gl.POINTS, 0, this.drawn.points);
  }
}

// True without a graphics card: smooth edges then cost four times the pixels.
function drawsInSoftware() {
  const gl = document.createElement('canvas').getContext('webgl2');
  const names = gl && gl.getExtension('WEBGL_debug_renderer_info');
  const found = Boolean(names) && /swiftshader|llvmpipe|software|basic render/i.test(gl.getParameter(names.UNMASKED_RENDERER_WEBGL));
  if (gl && gl.getExtension('WEBGL_lose_context')) gl.getExtension('WEBGL_lose_context').loseContext();
  return found;
}

// Draws neighbours of the same kind in one call.
function joined(ranges) {
  const out = [];
  for (const range of ranges) {
    const last = out[out.length - 1];
    if (last && last.ground === range.ground && last.clear === range.clear) last.count += range.count;
    else out.push(Object.assign({}, range));
  }
  return out;
}

// Range of heights that contains nine tenths of the points, as an actor places them.
function heightsOf(actor, replay) {
  const positions = replay.array('points.positions'), times = replay.array('points.times'), scale = replay.head.points.scale_m, heights = [];
  for (let i = 0; i < times.length; i += Math.ceil(times.length / 4000)) {
    const pose = actor.track.pose(times[i] * 1e-6);
    if (!pose) continue;
    const body = poseMatrix(pose.p, pose.q);
    heights.push(pose.p[2] + scale * (body[2] * positions[3 * i] + body[6] * positions[3 * i + 1] + body[10] * positions[3 * i + 2]));
  }
  heights.sort((a, b) => a - b);
  const at = (share) => heights[Math.floor(share * (heights.length - 1))] || 0;
  return [at(0.05), Math.max(at(0.95), at(0.05) + 0.1)];
}

// Colours of heights: violet to amber with increasing lightness, visible on light and dark ground (after matplotlib's plasma).
const HEIGHT_COLOURS = Array.from({ length: 64 }, (unused, i) => {
  const stops = [[84, 70, 190], [142, 50, 170], [204, 71, 120], [237, 121, 83], [247, 165, 55]];
  const at = i / 63 * (stops.length - 1), k = Math.min(Math.floor(at), stops.length - 2);
  return mix(stops[k], stops[k + 1], at - k).map(Math.round);
});
