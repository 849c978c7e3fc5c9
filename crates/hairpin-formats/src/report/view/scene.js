// The picture: lines, meshes and points by WebGL, and words on a second canvas above it.

/** @type {(a: V3, b: V3) => V3} */ const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
/** @type {(a: V3, b: V3) => V3} */ const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
/** @type {(a: V3, s: number) => V3} */ const times = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
/** @type {(a: V3, b: V3) => number} */ const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
/** @type {(a: V3, b: V3) => V3} */ const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
/** @type {(a: V3) => V3} */ const unit = (a) => times(a, 1 / (Math.sqrt(dot(a, a)) || 1));
/** @type {(a: V3, b: V3, s: number) => V3} */ const between = (a, b, s) => add(a, times(sub(b, a), s));

/** @type {(q: Q4, r: Q4) => Q4} */ const after = ([a, b, c, d], [e, f, g, h]) => [
  a * e - b * f - c * g - d * h, a * f + b * e + c * h - d * g, a * g - b * h + c * e + d * f, a * h + b * g - c * f + d * e,
];
/** @type {(q: Q4, v: V3) => V3} */ function rotate([w, x, y, z], v) {
  const u = /** @type {V3} */ ([x, y, z]), t = times(cross(u, v), 2);
  return add(v, add(times(t, w), cross(u, t)));
}
/** @type {(axis: V3, angle: number) => Q4} */ const turn = (axis, angle) => [Math.cos(angle / 2), ...times(axis, Math.sin(angle / 2))];
/** @type {(a: Q4, b: Q4, s: number) => Q4} */ function midway(a, b, s) {
  const side = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] < 0 ? -1 : 1;
  const q = a.map((v, i) => v * (1 - s) + side * b[i] * s), n = Math.hypot(...q) || 1;
  return /** @type {Q4} */ (q.map((v) => v / n));
}

/** Column-major. @type {(a: Float32Array, b: Float32Array) => Float32Array<ArrayBuffer>} */ function product(a, b) {
  const m = new Float32Array(16);
  for (let c = 0; c < 4; c++) for (let r = 0; r < 4; r++) for (let k = 0; k < 4; k++) m[c * 4 + r] += a[k * 4 + r] * b[c * 4 + k];
  return m;
}
/** World from a frame at `p`, turned by `q`, `s` times as large. @type {(p: V3, q: Q4, s: number) => Float32Array} */ function placed(p, q, s) {
  const [x, y, z] = [rotate(q, [s, 0, 0]), rotate(q, [0, s, 0]), rotate(q, [0, 0, s])];
  return new Float32Array([...x, 0, ...y, 0, ...z, 0, ...p, 1]);
}

const SHADERS = {
  mesh: [`#version 300 es
    in vec3 p; in float s; uniform mat4 vp, m; out vec3 w; out float shade;
    void main() { vec4 q = m * vec4(p, 1.0); w = q.xyz; shade = s; gl_Position = vp * q; }`, `#version 300 es
    precision highp float; in vec3 w; in float shade; uniform vec4 colour, dark; uniform float lit, hatch; out vec4 o;
    void main() {
      vec3 n = normalize(cross(dFdx(w), dFdy(w)));
      vec3 c = lit > 0.5 ? colour.rgb * (0.6 + 0.4 * abs(dot(n, normalize(vec3(-0.35, -0.5, 0.8))))) : mix(dark.rgb, colour.rgb, shade);
      if (hatch > 0.5 && mod(gl_FragCoord.x + gl_FragCoord.y, 9.0) < 3.0) c = mix(c, dark.rgb, 0.5);
      o = vec4(c * colour.a, colour.a);
    }`],
  line: [`#version 300 es
    in vec2 corner; in vec3 a, b; in vec2 far; in vec4 ca, cb; uniform mat4 vp; uniform vec2 view; uniform float width; out vec4 c; out float along;
    void main() {
      vec4 A = vp * vec4(a, 1.0), B = vp * vec4(b, 1.0); float e = 1e-4;
      if (A.w < e && B.w > e) A = mix(A, B, (e - A.w) / (B.w - A.w)); else if (B.w < e && A.w > e) B = mix(B, A, (e - B.w) / (A.w - B.w));
      vec2 d = (B.xy / B.w - A.xy / A.w) * view; d = dot(d, d) < 1e-9 ? vec2(1.0, 0.0) : normalize(d);
      vec4 P = corner.x < 0.5 ? A : B;
      P.xy += (vec2(-d.y, d.x) * corner.y + d * (corner.x - 0.5) * 0.7) * width / view * P.w; P.z -= 3e-4 * P.w;
      c = corner.x < 0.5 ? ca : cb; along = corner.x < 0.5 ? far.x : far.y; gl_Position = P;
    }`, `#version 300 es
    precision highp float; in vec4 c; in float along; uniform float dash; out vec4 o;
    void main() { if (dash > 0.0 && fract(along / dash) > 0.6) discard; o = vec4(c.rgb * c.a, c.a); }`],
};

/** @typedef {{ points: V3[], colours: number[][], width: number, dash: number }} Line */
/** @typedef {{ array: WebGLVertexArrayObject, count: number }} Drawn */
/** @typedef {{ mesh: Drawn, at: Float32Array, colour: number[], dark: number[], lit: boolean, hatch: boolean }} Solid */
/** @typedef {{ p: V3, text: string, look: string }} Word */

class Scene {
  /** @param {HTMLCanvasElement} canvas @param {HTMLCanvasElement} ink */ constructor(canvas, ink) {
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: false });
    const pen = ink.getContext("2d");
    if (!gl || !pen) throw new Error("the browser has no WebGL");
    this.canvas = canvas; this.ink = ink; this.gl = gl; this.pen = pen;
    this.programs = { mesh: this.program(SHADERS.mesh), line: this.program(SHADERS.line) };
    this.corners = /** @type {WebGLBuffer} */ (gl.createBuffer());
    gl.bindBuffer(gl.ARRAY_BUFFER, this.corners);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array([0, -1, 0, 1, 1, -1, 1, 1]), gl.STATIC_DRAW);
    /** @type {V3} */ this.target = [0, 0, 0];
    this.azimuth = -1.1; this.elevation = 0.5; this.distance = 10; this.reach = 1;
    this.width = this.height = this.ratio = 1;
    this.vp = new Float32Array(16);
    /** Solids first, then lines, then what one sees through. @type {{ solids: Solid[], lines: { drawn: Drawn, width: number, dash: number }[], glass: Solid[], words: Word[] }} */
    this.parts = { solids: [], lines: [], glass: [], words: [] };
  }

  /** @param {string[]} texts @returns {WebGLProgram} */ program([vertex, fragment]) {
    const gl = this.gl, program = /** @type {WebGLProgram} */ (gl.createProgram());
    for (const [kind, text] of /** @type {[number, string][]} */ ([[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]])) {
      const shader = /** @type {WebGLShader} */ (gl.createShader(kind));
      gl.shaderSource(shader, text); gl.compileShader(shader); gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program) || "no shader");
    return program;
  }

  /** @param {WebGLProgram} program @param {string} name @param {number} size @param {number} stride @param {number} at @param {boolean} [each] @param {boolean} [bytes] */
  attribute(program, name, size, stride, at, each, bytes) {
    const gl = this.gl, place = gl.getAttribLocation(program, name);
    if (place < 0) return;
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, size, bytes ? gl.UNSIGNED_BYTE : gl.FLOAT, Boolean(bytes), stride, at);
    gl.vertexAttribDivisor(place, each ? 1 : 0);
  }

  /** Triangles; `shade` is each corner's light, where it is known. @param {ArrayLike<number>} xyz @param {ArrayLike<number>} triangles @param {ArrayLike<number>} [shade] @returns {Drawn} */
  mesh(xyz, triangles, shade) {
    const gl = this.gl, array = /** @type {WebGLVertexArrayObject} */ (gl.createVertexArray()), count = xyz.length / 3;
    const data = new Float32Array(4 * count);
    for (let i = 0; i < count; i++) data.set([xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2], shade ? shade[i] : 1], 4 * i);
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
    this.attribute(this.programs.mesh, "p", 3, 16, 0);
    this.attribute(this.programs.mesh, "s", 1, 16, 12);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint32Array(triangles), gl.STATIC_DRAW);
    gl.bindVertexArray(null);
    return { array, count: triangles.length };
  }

  /** A line from point to point; colours are one for all or one each, 0 … 255 with alpha. @param {Line} line */ line({ points, colours, width, dash }) {
    const gl = this.gl, array = /** @type {WebGLVertexArrayObject} */ (gl.createVertexArray()), count = Math.max(0, points.length - 1);
    const buffer = new ArrayBuffer(40 * count), floats = new Float32Array(buffer), bytes = new Uint8Array(buffer);
    for (let i = 0, far = 0; i < count; i++) {
      const [a, b] = [points[i], points[i + 1]], next = far + Math.sqrt(dot(sub(b, a), sub(b, a)));
      floats.set([...a, ...b, far, next], 10 * i);
      bytes.set([...(colours[i] || colours[0]), ...(colours[i + 1] || colours[0])], 40 * i + 32);
      far = next;
    }
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.corners);
    this.attribute(this.programs.line, "corner", 2, 8, 0);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, buffer, gl.STATIC_DRAW);
    for (const [name, size, at, small] of /** @type {[string, number, number, boolean][]} */ ([["a", 3, 0, false], ["b", 3, 12, false], ["far", 2, 24, false], ["ca", 4, 32, true], ["cb", 4, 36, true]])) {
      this.attribute(this.programs.line, name, size, 40, at, true, small);
    }
    gl.bindVertexArray(null);
    return { drawn: { array, count }, width, dash };
  }

  /** The camera's axes: right, up, and from the target to the eye. @returns {[V3, V3, V3]} */ axes() {
    const [ca, sa, ce, se] = [Math.cos(this.azimuth), Math.sin(this.azimuth), Math.cos(this.elevation), Math.sin(this.elevation)];
    return [[-sa, ca, 0], [-ca * se, -sa * se, ce], [ca * ce, sa * ce, se]];
  }

  /** @returns {V3} */ eye() { return add(this.target, times(this.axes()[2], this.distance)); }

  /** Sets target and distance so that all of `points` are seen. @param {V3[]} points */ frame(points) {
    if (!points.length) return;
    this.resize();
    const [right, up, back] = this.axes(), wide = SPAN * (this.width / this.height), margin = 0.84;
    const along = (/** @type {V3} */ axis) => points.map((p) => dot(p, axis));
    const middle = (/** @type {number[]} */ v) => (Math.min(...v) + Math.max(...v)) / 2;
    this.target = [right, up, back].map((axis) => times(axis, middle(along(axis)))).reduce(add);
    this.distance = 1e-6;
    for (const p of points) {
      const d = sub(p, this.target);
      this.distance = Math.max(this.distance, dot(d, back) + Math.max(Math.abs(dot(d, right)) / wide, Math.abs(dot(d, up)) / SPAN) / margin);
    }
    this.distance = Math.max(this.distance, 0.02 * this.reach);
  }

  /** Where a place is on the screen, px, and how far it is; null behind the eye. @param {V3} p @returns {V3 | null} */ project(p) {
    const m = this.vp, w = m[3] * p[0] + m[7] * p[1] + m[11] * p[2] + m[15];
    if (w <= 1e-6) return null;
    const x = (m[0] * p[0] + m[4] * p[1] + m[8] * p[2] + m[12]) / w, y = (m[1] * p[0] + m[5] * p[1] + m[9] * p[2] + m[13]) / w;
    return [(x + 1) / 2 * this.width, (1 - y) / 2 * this.height, w];
  }

  /** Pixels that a metre at `p` has. @param {V3} p */ scaleAt(p) { return this.height / (2 * SPAN * Math.max(1e-9, dot(sub(this.eye(), p), this.axes()[2]))); }

  resize() {
    const box = this.canvas.getBoundingClientRect(), ratio = Math.min(window.devicePixelRatio || 1, 2);
    const [w, h] = [Math.max(1, Math.round(box.width)), Math.max(1, Math.round(box.height))];
    if (w === this.width && h === this.height && ratio === this.ratio) return;
    [this.width, this.height, this.ratio] = [w, h, ratio];
    for (const c of [this.canvas, this.ink]) [c.width, c.height] = [Math.round(w * ratio), Math.round(h * ratio)];
  }

  /** @param {Theme} theme */ draw(theme) {
    this.resize();
    const gl = this.gl, [right, up, back] = this.axes(), eye = this.eye();
    const near = Math.max(this.distance * 0.02, this.reach * 1e-4), far = this.distance + 6 * this.reach;
    const look = new Float32Array([right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0, -dot(right, eye), -dot(up, eye), -dot(back, eye), 1]);
    const f = 1 / SPAN, lens = new Float32Array([f * this.height / this.width, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, 2 * far * near / (near - far), 0]);
    this.vp = product(lens, look);
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(...channels(theme.paper), 1); gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST); gl.enable(gl.BLEND); gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    this.solids(this.parts.solids);
    const program = this.programs.line, at = (/** @type {string} */ name) => gl.getUniformLocation(program, name);
    gl.useProgram(program);
    gl.uniformMatrix4fv(at("vp"), false, this.vp); gl.uniform2f(at("view"), this.width, this.height);
    for (const { drawn, width, dash } of this.parts.lines) {
      gl.uniform1f(at("width"), width); gl.uniform1f(at("dash"), dash); gl.bindVertexArray(drawn.array);
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, drawn.count);
    }
    gl.depthMask(false); this.solids(this.parts.glass); gl.depthMask(true);
    gl.bindVertexArray(null);
    this.write(theme);
  }

  /** @param {Solid[]} solids */ solids(solids) {
    const gl = this.gl, program = this.programs.mesh, at = (/** @type {string} */ name) => gl.getUniformLocation(program, name);
    gl.useProgram(program);
    gl.uniformMatrix4fv(at("vp"), false, this.vp);
    for (const { mesh, at: place, colour, dark, lit, hatch } of solids) {
      gl.uniformMatrix4fv(at("m"), false, place); gl.uniform4fv(at("colour"), colour); gl.uniform4fv(at("dark"), dark);
      gl.uniform1f(at("lit"), lit ? 1 : 0); gl.uniform1f(at("hatch"), hatch ? 1 : 0); gl.bindVertexArray(mesh.array);
      gl.drawElements(gl.TRIANGLES, mesh.count, gl.UNSIGNED_INT, 0);
    }
  }

  /** Words with a rim of paper around them, so that they are read over anything. @param {Theme} theme */ write(theme) {
    const pen = this.pen;
    pen.setTransform(this.ratio, 0, 0, this.ratio, 0, 0); pen.clearRect(0, 0, this.width, this.height); pen.lineJoin = "round";
    const taken = /** @type {number[][]} */ ([]), order = ["worst", "point", "tick"], words = [...this.parts.words].sort((a, b) => order.indexOf(a.look) - order.indexOf(b.look));
    for (const { p, text, look } of words) {
      const at = this.project(p);
      if (!at || at[0] < 0 || at[0] > this.width || at[1] < 0 || at[1] > this.height) continue;
      const [x, y] = at, small = look === "tick";
      pen.strokeStyle = theme.paper; pen.fillStyle = small ? theme.soft : theme.ink;
      if (look === "point" || look === "worst") {
        pen.beginPath(); pen.arc(x, y, look === "worst" ? 18 : 3.5, 0, 7);
        pen.lineWidth = look === "worst" ? 5 : 2; pen.stroke();
        if (look === "worst") { pen.strokeStyle = theme.ink; pen.lineWidth = 2.5; pen.stroke(); pen.strokeStyle = theme.paper; } else pen.fill();
      }
      pen.font = `${look === "tick" ? "" : look === "worst" ? "700 " : "600 "}${small ? 11 : 13}px system-ui, sans-serif`;
      const wide = pen.measureText(text).width, [dx, dy] = small ? [-wide / 2, 4] : look === "worst" ? [22, -14] : [6, -6];
      const left = Math.min(Math.max(4, x + dx), this.width - wide - 4), top = Math.min(Math.max(14, y + dy), this.height - 6);
      // Where words would lie on others they are left out: the worst moment's are first, then places', then ticks'.
      if (!text || taken.some(([x, y, far]) => left < far && x < left + wide + 3 && Math.abs(top - y) < 13)) continue;
      taken.push([left, top, left + wide + 3]);
      pen.lineWidth = 4; pen.strokeText(text, left, top); pen.fillText(text, left, top);
    }
  }
}

/** Half of the height of what the camera sees at distance 1. */
const SPAN = Math.tan(0.28);

/** Red, green, blue, 0 … 1, of #rrggbb. @type {(hex: string) => V3} */
const channels = (hex) => /** @type {V3} */ ([1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255));
/** The same 0 … 255 with alpha. @type {(hex: string, alpha?: number) => number[]} */
const rgba = (hex, alpha = 1) => [...channels(hex), alpha].map((v) => Math.round(255 * v));

/** Where the ray from `from` along `way` first meets a triangle, as multiples of `way`; Infinity where it does not (Möller, Trumbore). @param {V3} from @param {V3} way @param {ArrayLike<number>} xyz @param {ArrayLike<number>} triangles */
function meets(from, way, xyz, triangles) {
  let first = Infinity;
  const corner = (/** @type {number} */ i) => /** @type {V3} */ ([xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]]);
  for (let k = 0; k + 2 < triangles.length; k += 3) {
    const a = corner(triangles[k]), u = sub(corner(triangles[k + 1]), a), v = sub(corner(triangles[k + 2]), a);
    const h = cross(way, v), det = dot(u, h);
    if (Math.abs(det) < 1e-12) continue;
    const s = sub(from, a), x = dot(s, h) / det, q = cross(s, u), y = dot(way, q) / det, t = dot(v, q) / det;
    if (x >= 0 && y >= 0 && x + y <= 1 && t > 1e-9 && t < first) first = t;
  }
  return first;
}
