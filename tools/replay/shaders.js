// Shaders: one light, soft ambient light, haze with distance, and a cut through objects between the camera and its
// target.
const HAZE = `
  uniform vec3 u_eye, u_haze;
  uniform float u_haze_m;
  vec3 hazed(vec3 colour, vec3 position) {
    float far = clamp(distance(position, u_eye) / u_haze_m, 0.0, 1.0);
    return mix(colour, u_haze, far * far * (3.0 - 2.0 * far));
  }`;

const SHADERS = {
  sky: [`
    out vec2 v_at;
    void main() {
      v_at = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0;
      gl_Position = vec4(v_at, 0.9999, 1.0);
    }`, `
    in vec2 v_at;
    uniform vec3 u_high, u_low;
    uniform float u_horizon;
    out vec4 o_colour;
    void main() {
      float up = smoothstep(-0.1, 1.1, v_at.y - u_horizon);
      o_colour = vec4(mix(u_low, u_high, up), 1.0);
    }`],

  // bodies of the world and of the robots
  solid: [`
    layout(location = 0) in vec3 a_position;
    layout(location = 1) in vec3 a_normal;
    layout(location = 2) in vec4 a_colour;
    uniform mat4 u_camera, u_body, u_shadow;
    out vec3 v_position, v_normal, v_shadow;
    out vec4 v_colour;
    void main() {
      vec4 position = u_body * vec4(a_position, 1.0);
      v_position = position.xyz;
      v_normal = mat3(u_body) * a_normal;
      v_colour = a_colour;
      vec4 shadow = u_shadow * vec4(position.xyz + 0.02 * v_normal, 1.0);
      v_shadow = shadow.xyz * 0.5 + 0.5;
      gl_Position = u_camera * position;
    }`, `
    in vec3 v_position, v_normal, v_shadow;
    in vec4 v_colour;
    uniform highp sampler2DShadow u_depths;
    uniform vec3 u_sun, u_target;
    uniform vec4 u_tint;          // colour, and its weight
    uniform float u_light, u_opacity, u_shadows, u_grid, u_cut_m;
    out vec4 o_colour;
    ${HAZE}
    float lit() {
      if (u_shadows < 0.5) return 1.0;
      vec2 off = abs(v_shadow.xy - 0.5);
      if (max(off.x, off.y) > 0.495) return 1.0;
      float sum = 0.0, texel = 1.0 / float(textureSize(u_depths, 0).x);
      for (int i = 0; i < 4; ++i) {
        vec2 at = v_shadow.xy + (vec2(i & 1, i >> 1) - 0.5) * 1.4 * texel;
        sum += texture(u_depths, vec3(at, v_shadow.z - 0.0012));
      }
      float edge = smoothstep(0.40, 0.49, max(off.x, off.y));
      return mix(0.25 * sum, 1.0, edge);
    }
    void main() {
      if (u_cut_m > 0.0) {
        // a dithered hole through objects that hide the target, within half its distance about the line of sight
        vec3 ahead = u_target - u_eye;
        float along = dot(v_position - u_eye, ahead) / dot(ahead, ahead);
        float aside = distance(v_position - u_eye, along * ahead);
        float keep = max(smoothstep(0.72, 0.95, along), smoothstep(0.6, 1.1, aside / (u_cut_m * max(along, 0.15))));
        float dither = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
        if (keep < dither) discard;
      }
      vec3 normal = normalize(gl_FrontFacing ? v_normal : -v_normal);
      vec3 albedo = mix(v_colour.rgb, u_tint.rgb, u_tint.a);
      float grid = 0.0;
      if (u_grid > 0.0) {
        // a grid line each metre shows slope and scale
        vec2 cell = abs(fract(v_position.xy / u_grid - 0.5) - 0.5) * u_grid / max(fwidth(v_position.xy), vec2(1e-5));
        grid = (1.0 - min(min(cell.x, cell.y), 1.0)) * 0.16 * smoothstep(30.0, 6.0, distance(v_position, u_eye));
        // two shades of grass
        float spot = sin(v_position.x * 1.7) * sin(v_position.y * 1.3 + 1.0) + sin(v_position.x * 0.53 - v_position.y * 0.71);
        albedo *= 1.0 + 0.05 * spot;
      }
      float sun = max(dot(normal, u_sun), 0.0) * lit();
      float sky = 0.5 + 0.5 * normal.z;
      vec3 light = vec3(1.0, 0.95, 0.86) * (0.85 * sun) + mix(vec3(0.24, 0.22, 0.20), vec3(0.46, 0.52, 0.60), sky);
      light += 0.16 * max(dot(normal, normalize(u_eye - v_position)), 0.0);  // light from the viewpoint, so that no side is black
      vec3 colour = albedo * light * u_light;
      colour = mix(colour, vec3(u_light), grid);
      o_colour = vec4(hazed(colour, v_position), u_opacity * v_colour.a);
    }`],

  // depths as seen from the sun, for shadows
  shadow: [`
    layout(location = 0) in vec3 a_position;
    uniform mat4 u_camera, u_body;
    void main() { gl_Position = u_camera * u_body * vec4(a_position, 1.0); }`, `
    void main() {}`],

  // a path: a band that faces the camera, at least one pixel wide
  ribbon: [`
    layout(location = 0) in vec3 a_position;
    layout(location = 1) in vec3 a_ahead;
    layout(location = 2) in vec2 a_side_time;
    uniform mat4 u_camera;
    uniform vec3 u_eye;
    uniform float u_width_m, u_pixel;
    out float v_time, v_side;
    void main() {
      vec3 look = a_position - u_eye;
      vec3 across = cross(a_ahead, look);
      float size = length(across);
      across = size > 1e-6 ? across / size : vec3(0.0, 0.0, 1.0);
      float half_m = max(0.5 * u_width_m, 1.3 * u_pixel * length(look));
      v_time = a_side_time.y;
      v_side = a_side_time.x;
      gl_Position = u_camera * vec4(a_position + across * half_m * a_side_time.x, 1.0);
    }`, `
    in float v_time, v_side;
    uniform vec3 u_colour;
    uniform float u_now, u_opacity;
    out vec4 o_colour;
    void main() {
      float past = smoothstep(0.004, -0.004, v_time - u_now);
      float edge = 1.0 - 0.35 * smoothstep(0.5, 1.0, abs(v_side));
      o_colour = vec4(u_colour * edge, u_opacity * mix(0.22, 1.0, past));
    }`],

  // lidar returns, placed by the selected motion at the time of each return
  points: [`
    layout(location = 0) in vec3 a_position;
    layout(location = 1) in uint a_time_us;
    layout(location = 2) in float a_error;
    uniform highp sampler2D u_poses;   // position and attitude, a pose in two texels
    uniform mat4 u_camera, u_mount;
    uniform vec3 u_eye;
    uniform uint u_step_us, u_last;
    uniform float u_scale_m, u_now_us, u_size, u_largest, u_by_error;
    uniform vec2 u_heights;
    out float v_share, v_fresh, v_known;
    vec4 texel(uint i) { return texelFetch(u_poses, ivec2(int(i & 1023u), int(i >> 10)), 0); }
    void main() {
      uint k = min(a_time_us / u_step_us, u_last);
      uint next = min(k + 1u, u_last);
      float share = float(a_time_us - k * u_step_us) / float(u_step_us);
      vec4 p = texel(2u * k), p_next = texel(2u * next), q = texel(2u * k + 1u), q_next = texel(2u * next + 1u);
      if (dot(q, q_next) < 0.0) q_next = -q_next;
      q = normalize(mix(q, q_next, share));
      vec3 in_body = (u_mount * vec4(a_position * u_scale_m, 1.0)).xyz;
      vec3 position = mix(p.xyz, p_next.xyz, share) + in_body + 2.0 * cross(q.xyz, cross(q.xyz, in_body) + q.w * in_body);
      bool lost = p.w < 0.5 || p_next.w < 0.5;
      float age_s = (u_now_us - float(a_time_us)) * 1e-6;
      v_fresh = exp(-6.0 * max(age_s, 0.0));
      v_known = u_by_error > 0.5 && a_error > 254.5 ? 0.0 : 1.0;
      v_share = u_by_error > 0.5 ? a_error / 254.0 : clamp((position.z - u_heights.x) / (u_heights.y - u_heights.x), 0.0, 1.0);
      position += 0.03 * normalize(u_eye - position);  // moves the point in front of its surface
      gl_Position = lost ? vec4(2.0, 2.0, 2.0, 1.0) : u_camera * vec4(position, 1.0);
      gl_PointSize = clamp(u_size * (1.0 + 0.9 * v_fresh) / max(gl_Position.w, 0.1), 1.6, u_largest);
    }`, `
    in float v_share, v_fresh, v_known;
    uniform sampler2D u_colours;
    uniform float u_glow;
    out vec4 o_colour;
    void main() {
      vec2 off = gl_PointCoord - 0.5;
      if (dot(off, off) > 0.25) discard;
      vec3 colour = v_known > 0.5 ? texture(u_colours, vec2(v_share * (63.0 / 64.0) + 0.5 / 64.0, 0.5)).rgb : vec3(0.5);
      o_colour = vec4(mix(colour, vec3(1.0), u_glow * v_fresh), 1.0);
    }`],
};

// Throws with the compiler's message.
function compiled(gl, name) {
  const program = gl.createProgram();
  SHADERS[name].forEach((text, i) => {
    const shader = gl.createShader(i === 0 ? gl.VERTEX_SHADER : gl.FRAGMENT_SHADER);
    gl.shaderSource(shader, `#version 300 es\nprecision highp float;\nprecision highp int;\n${text}`);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(`shader ${name}: ${gl.getShaderInfoLog(shader)}`);
    gl.attachShader(program, shader);
  });
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(`shader ${name}: ${gl.getProgramInfoLog(program)}`);
  const locations = {};
  for (let i = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS) - 1; i >= 0; --i) {
    const uniform = gl.getActiveUniform(program, i).name;
    locations[uniform] = gl.getUniformLocation(program, uniform);
  }
  return { program, at: locations };
}
