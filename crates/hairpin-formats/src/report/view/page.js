// What the reader does: opens a case, moves in time and in space, sorts, filters, copies.

const data = /** @type {ReportDataOfPage} */ (JSON.parse(/** @type {HTMLElement} */ (document.getElementById("data")).textContent || ""));
const byId = (/** @type {string} */ id) => /** @type {any} */ (document.getElementById(id));
const every = (/** @type {string} */ what) => /** @type {HTMLElement[]} */ ([...document.querySelectorAll(what)]);
const root = document.documentElement;
root.dataset.js = "1";

/** @param {Column} column */ function decode([offset, scale, text]) {
  const raw = atob(text), values = new Float64Array(raw.length / 2);
  for (let i = 0; i < values.length; i++) {
    const v = raw.charCodeAt(2 * i) | (raw.charCodeAt(2 * i + 1) << 8);
    values[i] = v === 65535 ? NaN : offset + scale * v;
  }
  return values;
}
/** @param {Column} x @param {Column} y @param {Column} z @returns {V3[]} */ function places(x, y, z) {
  const [a, b, c] = [decode(x), decode(y), decode(z)];
  return Array.from(a, (v, i) => [v, b[i], c[i]]);
}
/** @param {MotionData} m @returns {Motion} */ function motion(m) {
  const q = m.q && m.q.map(decode), channels = Object.fromEntries(Object.entries(m.channels).map(([name, column]) => [name, decode(column)]));
  return { t: decode(m.t), p: places(m.x, m.y, m.z), q: q && Array.from(q[0], (w, i) => [w, q[1][i], q[2][i], q[3][i]]), channels };
}
/** Distance driven, for wheels that roll. @param {Motion} m */ function rolled(m) {
  const v = m.channels.speed_m_s, sum = new Float64Array(m.t.length);
  for (let i = 1; v && i < sum.length; i++) sum[i] = sum[i - 1] + 0.5 * (v[i] + v[i - 1]) * (m.t[i] - m.t[i - 1]);
  m.channels.rolled = sum;
}
const known = /** @type {Map<number, Case>} */ (new Map());
/** @param {number} index @returns {Case} */ function caseOf(index) {
  const found = known.get(index), c = data.cases[index];
  if (found) return found;
  const f = c.flown, flown = f && { ...motion(f), d: decode(f.d), judged: decode(f.judged), v: decode(f.v), leg: f.leg && decode(f.leg) };
  if (flown) rolled(flown);
  const made = { data: c, planned: motion(c.planned), flown, runs: c.runs.map((r) => ({ run: r.run, t: decode(r.t), d: decode(r.d), p: places(r.x, r.y, r.z) })) };
  known.set(index, made);
  return made;
}
/** The stamp before `t`, and how far `t` is on the way to the next. @param {Float64Array} times @param {number} t @returns {[number, number]} */
function stamp(times, t) {
  let [low, high] = [0, times.length - 1];
  while (high - low > 1) { const middle = (low + high) >> 1; if (times[middle] <= t) low = middle; else high = middle; }
  const share = high > low ? (t - times[low]) / (times[high] - times[low]) : 0; // what the page has of stamps is rounded
  return [low, share < 0.02 ? 0 : share > 0.98 ? 1 : share];
}
/** @param {ArrayLike<number> | null | undefined} values @param {[number, number]} at */
const valueAt = (values, [i, s]) => (values ? values[i] + (s ? s * (values[i + 1] - values[i]) : 0) : NaN);

const state = { index: 0, t: 0, playing: false, speed: 1, ghost: true, follow: false, high: 1, chosen: /** @type {Set<number> | null} */ (null) };
/** @type {Theme} */ let theme = {};
/** @type {Scene | null} */ let scene = null;
/** @type {(t: number) => void} */ let cursor = () => {};
let [waiting, last] = [false, 0];

function readTheme() {
  const style = getComputedStyle(root);
  theme = Object.fromEntries(["ink", "soft", "line", "paper", "plan", "flown", "now", "solid", "dark", "land", "shadow", "body", "nose", "wheel", "d0", "d1", "d2", "d3", "d4"].map((name) => [name, style.getPropertyValue("--" + name).trim()]));
}
/** Colour of a deviation: lightness changes all along, so the order is seen without colours as well. @param {number} share */ function heat(share) {
  const at = Math.min(0.9999, Math.max(0, share || 0)) * 4, i = Math.floor(at), [a, b] = [rgba(theme["d" + i]), rgba(theme["d" + (i + 1)])];
  return a.map((v, k) => Math.round(v + (at - i) * (b[k] - v)));
}

/** Where a place is drawn: heights may be exaggerated. @type {(p: V3) => V3} */
const lifted = (p) => (state.high === 1 ? p : [p[0], p[1], data.low[2] + state.high * (p[2] - data.low[2])]);
const HERE = new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
const colour = (/** @type {string} */ name, alpha = 1) => [...channels(theme[name]), alpha];

/** @type {{ world: Solid[], glass: Solid[], lines: ReturnType<Scene["line"]>[], words: Word[], targets: { name: string, xyz: number[], t: Float64Array }[], robot: { mesh: Drawn, link: number }[] }} */
let built = { world: [], glass: [], lines: [], words: [], targets: [], robot: [] };

/** Everything of a case that does not move. */
function build() {
  if (!scene) return;
  const s = scene, c = caseOf(state.index), f = c.flown, high = add(data.low, data.size);
  for (const { drawn } of built.lines) s.gl.deleteVertexArray(drawn.array);
  for (const { mesh } of [...built.world, ...built.glass]) s.gl.deleteVertexArray(mesh.array);
  built = { world: [], glass: [], lines: [], words: [], targets: [], robot: built.robot };
  s.reach = Math.sqrt(dot(data.size, data.size));
  const line = (/** @type {V3[]} */ points, /** @type {number[][]} */ colours, /** @type {number} */ width, dash = 0) => built.lines.push(s.line({ points: points.map(lifted), colours, width, dash }));
  if (data.relief) {
    const { low, step, rows, columns, z, shade } = data.relief, heights = decode(z), xyz = [], triangles = [];
    for (let r = 0; r < rows; r++) for (let k = 0; k < columns; k++) xyz.push(...lifted([low[0] + k * step, low[1] + r * step, heights[r * columns + k] || data.low[2]]));
    for (let r = 0; r + 1 < rows; r++) for (let k = 0; k + 1 < columns; k++) {
      const i = r * columns + k, four = [i, i + 1, i + columns, i + columns + 1];
      if (!four.some((v) => Number.isNaN(heights[v]))) triangles.push(four[0], four[1], four[2], four[1], four[3], four[2]);
    }
    built.world.push({ mesh: s.mesh(xyz, triangles, decode(shade)), at: HERE, colour: colour("land"), dark: colour("shadow"), lit: false, hatch: false });
    for (const a of [0, 1]) for (const at of ticks(data.low[a], high[a], 10)) {
      const k = Math.min(Math.round((at - low[a]) / step), (a ? rows : columns) - 1), cells = Array.from({ length: a ? columns : rows }, (_, i) => (a ? [i, k] : [k, i]));
      const along = cells.map(([i, r]) => /** @type {V3} */ ([low[0] + i * step, low[1] + r * step, heights[r * columns + i]]));
      line(along.filter((p) => !Number.isNaN(p[2])), [rgba(theme.shadow, 0.4)], 1);
    }
  } else {
    const [u, v] = [data.low, high], faint = [rgba(theme.line)];
    for (const [a, b] of [[0, 1], [1, 0]]) for (const at of ticks(u[a], v[a], 10)) {
      const p = /** @type {V3} */ ([...u]), q = /** @type {V3} */ ([...u]);
      [p[a], q[a], q[b]] = [at, at, v[b]];
      line([p, q], faint, 1);
    }
    const corner = (/** @type {number} */ i) => /** @type {V3} */ ([0, 1, 2].map((k) => (i >> k & 1 ? v[k] : u[k])));
    for (let i = 0; i < 8; i++) for (const bit of [1, 2, 4]) if (!(i & bit)) line([corner(i), corner(i | bit)], faint, 1.5);
  }
  for (const axis of [0, 1]) for (const at of ticks(data.low[axis], high[axis], 6)) {
    const p = /** @type {V3} */ ([...data.low]);
    p[axis] = at;
    built.words.push({ p: lifted(p), text: `${short(at)}${at === ticks(data.low[axis], high[axis], 6).pop() ? " m " + "xy"[axis] : ""}`, look: "tick" });
  }
  for (const o of [...data.obstacles, ...c.data.obstacles]) {
    const v = decode(o.v), t = decode(o.t), xyz = [];
    for (let i = 0; i < v.length; i += 3) xyz.push(...lifted([v[i], v[i + 1], v[i + 2]]));
    built.targets.push({ name: o.name, xyz, t });
    built.glass.push({ mesh: s.mesh(xyz, t), at: HERE, colour: colour("solid", 0.5), dark: colour("dark"), lit: true, hatch: false });
  }
  for (const run of c.runs) line(run.p, [rgba(theme.soft, c.runs.length > 2 ? 0.45 : 0.9)], c.runs.length > 2 ? 1.5 : 3);
  line(c.planned.p, [rgba(theme.plan)], 3, s.reach / 60);
  if (f) {
    const top = deepest(f);
    line(f.p, Array.from(f.d, (d) => heat(d / top)), 5);
    byId("scale-top").textContent = `${fixed(top)} ${data.unit}`;
  }
  c.data.waypoints.forEach((p, i) => built.words.push({ p: lifted(p), text: String(i), look: "point" }));
  if (f) built.words.push({ p: lifted(placeAt(f, c.data.at)), text: c.data.mark || "", look: "worst" });
}
/** The end of the colours' scale. @param {Flown} f */ const deepest = (f) => Math.max(range(f.d)[1], data.limit || 0, 1e-9);
/** @param {Motion} m @param {number} t @returns {V3} */ function placeAt(m, t) { const [i, s] = stamp(m.t, t); return s ? between(m.p[i], m.p[i + 1], s) : m.p[i]; }
/** @param {Motion} m @param {number} t @returns {Q4} */ function attitudeAt(m, t) {
  const [i, s] = stamp(m.t, t);
  if (m.q) return s ? midway(m.q[i], m.q[i + 1], s) : m.q[i];
  const j = Math.min(i + 1, m.p.length - 1), way = sub(m.p[j], m.p[Math.max(0, j - 1)]);
  return turn([0, 0, 1], Math.atan2(way[1], way[0]));
}

/** The robot in the pose that it has at `t`; of a plan a ghost. @param {Motion} m @param {number} t @param {boolean} ghost @returns {{ solids: Solid[], lines: Line[], size: number }} */
function figure(m, t, ghost) {
  const robot = data.robot, s = /** @type {Scene} */ (scene), solids = /** @type {Solid[]} */ ([]), lines = /** @type {Line[]} */ ([]), at = stamp(m.t, t);
  if (!robot || (ghost && robot.fixed && !m.channels.q1_rad)) return { solids, lines, size: 1 };
  let p = lifted(placeAt(m, t)), q = attitudeAt(m, t), size = 1;
  if (robot.fixed) [p, q] = [[0, 0, 0], [1, 0, 0, 0]];
  else size = Math.max(1, 64 / (2 * Math.max(robot.radius, 1e-3) * s.scaleAt(p)));
  if (size > 1) p = add(p, rotate(q, [0, 0, (size - 1) * robot.lift]));
  const frames = /** @type {{ p: V3, q: Q4 }[]} */ ([]);
  robot.links.forEach((l) => {
    const base = l.parent < 0 ? { p, q } : frames[l.parent];
    let own = after(base.q, l.q), angle = NaN;
    if (l.by === "steer") {
      const k = valueAt(m.channels.curvature_1_m, at) || 0, way = valueAt(m.channels.travel_direction_rad, at) || 0;
      angle = Math.atan((Math.sin(way) + l.factor * k) / (Math.cos(way) - l.axis[1] * k || 1e-9));
      own = after(own, turn([0, 0, 1], angle));
    } else if (l.by) {
      angle = l.factor * valueAt(m.channels[l.by], at);
      if (!Number.isNaN(angle)) own = after(own, turn(l.axis, angle));
    }
    const place = add(base.p, rotate(base.q, times(l.p, size)));
    frames.push({ p: place, q: own });
    const push = l.thrust ? valueAt(m.channels[l.thrust], at) : NaN;
    if (!ghost && !Number.isNaN(push)) lines.push({ points: [place, add(place, rotate(own, [0, 0, 2 * robot.radius * size * push * push * l.factor]))], colours: [rgba(theme.now)], width: 4, dash: 0 });
  });
  for (const { mesh, link } of built.robot) {
    const { look, standIn } = robot.links[link], { p: place, q: own } = frames[link];
    solids.push({ mesh, at: placed(place, own, size), colour: ghost ? colour("plan", 0.3) : colour(look), dark: colour("paper"), lit: true, hatch: standIn && !ghost });
  }
  return { solids, lines, size };
}

function request() { if (!waiting) requestAnimationFrame((now) => { waiting = false; play(now); paint(); }); waiting = true; }
/** @param {number} now */ function play(now) {
  const f = caseOf(state.index).flown;
  if (!state.playing || !f) { last = 0; return; }
  const end = f.t[f.t.length - 1];
  if (last) state.t = Math.min(end, state.t + state.speed * (now - last) / 1000);
  last = now;
  if (state.t >= end) playing(false); else request();
  tell();
}
function paint() {
  if (!scene) return;
  const c = caseOf(state.index), f = c.flown, s = scene, made = /** @type {ReturnType<Scene["line"]>[]} */ ([]);
  s.parts = { solids: [...built.world], lines: [...built.lines], glass: [...built.glass], words: [...built.words] };
  let size = 1;
  if (f) {
    const p = lifted(placeAt(f, state.t));
    if (state.follow) s.target = p;
    const robot = figure(f, state.t, false), plan = state.ghost && figure(c.planned, state.t, true);
    size = robot.size;
    s.parts.solids.push(...robot.solids);
    if (plan) {
      // Where the plan is where the robot is there is nothing to tell apart.
      s.parts.glass.push(...plan.solids.filter(({ at }, i) => at.some((v, k) => Math.abs(v - robot.solids[i].at[k]) > 0.02)));
      made.push(s.line({ points: [p, lifted(placeAt(c.planned, state.t))], colours: [rgba(theme.now)], width: 2, dash: 0 }));
    }
    made.push(...robot.lines.map((line) => s.line(line)));
    if (!data.robot || data.robot.fixed) s.parts.words.push({ p, text: "", look: "point" });
  }
  s.parts.lines.push(...made);
  s.draw(theme);
  for (const { drawn } of made) s.gl.deleteVertexArray(drawn.array);
  const told = [size > 1.05 ? `robot drawn ${short(Number(size.toPrecision(2)))} × its size` : "", state.high > 1 ? `heights drawn ${state.high} × as high` : "", data.robot ? data.robot.told : "", data.obstaclesTold];
  byId("drawn-how").textContent = told.filter(Boolean).join(" · ");
}

/** The moment in words; slider and curves follow. */
function tell() {
  const f = caseOf(state.index).flown;
  if (!f) { byId("moment").textContent = "nothing was " + data.done; return; }
  const at = stamp(f.t, state.t), leg = f.leg ? `, leg ${Math.round(f.leg[at[0]])}→${Math.round(f.leg[at[0]]) + 1}` : "", v = valueAt(f.v, at);
  byId("time").value = String(state.t);
  byId("moment").textContent = `t = ${state.t.toFixed(2)} s${leg}, deviation ${fixed(valueAt(f.d, at))} ${data.unit}, ${v.toFixed(v < 1 ? 2 : 1)} m/s`;
  cursor(state.t);
}
/** @param {number} t */ function seek(t) {
  const f = caseOf(state.index).flown;
  if (f) state.t = Math.min(f.t[f.t.length - 1], Math.max(f.t[0], t));
  tell();
  request();
}
/** @param {boolean} on */ function playing(on) {
  const f = caseOf(state.index).flown;
  if (on && f && state.t >= f.t[f.t.length - 1]) state.t = f.t[0];
  state.playing = on;
  byId("play").textContent = on ? "❚❚" : "▶";
  byId("play").setAttribute("aria-label", on ? "stop" : "play");
  request();
}
/** All of the trajectory and its worst moment, seen from the side that it spreads to. @param {number} [azimuth] @param {number} [elevation] */
function fit(azimuth, elevation) {
  if (!scene) return;
  const c = caseOf(state.index), points = [...c.data.waypoints, ...c.planned.p, ...(c.flown ? c.flown.p : [])].map(lifted), n = points.length || 1;
  if (data.robot && data.robot.fixed && c.flown) for (const { at } of figure(c.flown, state.t, false).solids) points.push([at[12], at[13], at[14]], [at[12], at[13], 1.25 * at[14]]);
  const mean = times(points.reduce(add, [0, 0, 0]), 1 / n);
  const sum = (/** @type {number} */ a, /** @type {number} */ b) => points.reduce((s, p) => s + (p[a] - mean[a]) * (p[b] - mean[b]), 0);
  const side = 0.5 * Math.atan2(2 * sum(0, 1), sum(0, 0) - sum(1, 1)) - Math.PI / 2 + 0.35;
  scene.elevation = elevation === undefined ? 0.5 : elevation;
  scene.azimuth = azimuth === undefined ? side : azimuth;
  const worst = c.flown && lifted(placeAt(c.flown, c.data.at)), from = scene;
  // From the other side where an obstacle would hide the worst moment.
  const hidden = () => worst && built.targets.some(({ xyz, t }) => meets(from.eye(), sub(worst, from.eye()), xyz, t) < 0.999);
  scene.frame(points);
  if (azimuth === undefined && hidden()) { scene.azimuth += Math.PI; scene.frame(points); }
  request();
}

/** @param {number} index @param {boolean} [quiet] */ function select(index, quiet) {
  state.index = Math.max(0, Math.min(index, data.cases.length - 1));
  const c = caseOf(state.index), { id } = c.data, f = c.flown;
  for (const [name, text] of [["case-id", id], ["case-status", c.data.status], ["told", c.data.told]]) byId(name).textContent = text;
  byId("case-status").className = "status " + c.data.status;
  byId("pick").value = String(state.index);
  [byId("before").disabled, byId("after").disabled] = [state.index === 0, state.index === data.cases.length - 1];
  for (const part of every("figure.case, .findings")) part.hidden = part.dataset.case !== id;
  for (const row of every("tr[data-case]")) row.setAttribute("aria-selected", String(row.dataset.case === id));
  for (const name of ["time", "play", "worst-moment"]) byId(name).disabled = !f;
  byId("time").max = String(f ? f.t[f.t.length - 1] : 1);
  for (const part of every("button[data-verb=shrink]")) part.hidden = !c.data.fails;
  state.t = f ? c.data.at : 0; playing(false);
  build(); fit();
  cursor = drawSeries(byId("series"), c, data, seek);
  seek(state.t);
  if (!quiet) location.replace("#" + id);
  if (metrics.length) drawChosen();
}

const metrics = /** @type {Metric[]} */ (data.metrics.map((m) => ({ ...m, values: decode(m.values), random: m.random && decode(m.random) })));
const measures = [...metrics.map((m) => ({ name: `${m.name} ${m.unit}`.trim(), values: m.values })), ...data.draws.map((d) => ({ name: d.name, values: decode(d.values) }))];
/** @param {number[] | null} cases @param {string} [why] */ function choose(cases, why) {
  state.chosen = cases && new Set(cases);
  const ids = new Set((cases || []).map((i) => data.ids[i]));
  for (const row of every("table.cases tbody tr")) row.hidden = Boolean(cases) && !ids.has(row.dataset.case || "");
  byId("chosen").hidden = !cases; byId("chosen-words").textContent = cases ? `${cases.length} of ${data.ids.length} cases: ${why}` : "";
  drawChosen();
}
function drawChosen() {
  const place = byId("spread");
  place.textContent = "";
  for (const m of metrics) drawBars(place.appendChild(document.createElement("div")), m, state.chosen, choose);
  const [a, b] = [measures[byId("across").value], measures[byId("upward").value]];
  if (!a || !b) return;
  const current = data.cases.length ? data.ids.indexOf(data.cases[state.index].id) : -1;
  drawScatter(byId("scatter"), a, b, { ids: data.ids, fails: (i) => data.status[i] === "fail", chosen: state.chosen, current, open: (i) => {
    const index = data.cases.findIndex((c) => c.id === data.ids[i]);
    choose([i], "case " + data.ids[i]);
    if (index >= 0) { select(index); show(); } else byId("cases").scrollIntoView();
  } });
}
const show = () => byId("flight").scrollIntoView({ behavior: matchMedia("(prefers-reduced-motion: reduce)").matches ? "auto" : "smooth" });

/** The command that does `verb` to a case, typed where this page's folder is known. @param {string} verb @param {string} id */ function command(verb, id) {
  const place = data.folder || (location.protocol === "file:" ? decodeURIComponent(location.pathname).replace(/\/[^/]*$/, "") || "/" : "OUT");
  const out = /^[\w./~@%+=:,-]+$/.test(place) ? place : "'" + place.replaceAll("'", "'\\''") + "'";
  return `hairpin ${verb} ${out} ${verb === "export" ? "--to csv,mcap " : ""}--case ${id}`;
}
/** @param {HTMLElement} button */ async function copy(button) {
  const text = command(button.dataset.verb || "report", button.dataset.of || data.cases[state.index].id);
  byId("command").textContent = text;
  try { await navigator.clipboard.writeText(text); } catch { getSelection()?.selectAllChildren(byId("command")); document.execCommand("copy"); }
  byId("copied").textContent = "copied";
}
function picture() {
  if (!scene) return;
  const made = document.createElement("canvas"), pen = made.getContext("2d"), link = document.createElement("a");
  [made.width, made.height] = [scene.canvas.width, scene.canvas.height];
  paint();
  pen?.drawImage(scene.canvas, 0, 0);
  pen?.drawImage(scene.ink, 0, 0);
  link.download = `hairpin-${data.cases[state.index].id}-${state.t.toFixed(2)}s.png`;
  made.toBlob((blob) => { if (blob) { link.href = URL.createObjectURL(blob); link.click(); setTimeout(() => URL.revokeObjectURL(link.href), 1000); } });
}

/** @param {number} column @param {HTMLElement} header */ function sortBy(column, header) {
  const body = /** @type {HTMLTableElement} */ (header.closest("table")).tBodies[0], rows = [...body.rows], falling = header.getAttribute("aria-sort") !== "descending";
  for (const other of every("table.cases thead th")) other.setAttribute("aria-sort", "none");
  header.setAttribute("aria-sort", falling ? "descending" : "ascending");
  const key = (/** @type {HTMLTableRowElement} */ row) => {
    const text = (row.cells[column].textContent || "").trim(), value = parseFloat(text);
    return text === "–" ? null : Number.isNaN(value) ? text : value;
  };
  rows.sort((a, b) => {
    const [p, q] = [key(a), key(b)];
    if (p === null || q === null) return Number(p === null) - Number(q === null);
    const order = typeof p === "number" && typeof q === "number" ? p - q : String(p).localeCompare(String(q));
    return falling ? -order : order;
  });
  body.append(...rows);
}

/** Turn, move and zoom by mouse, fingers and keys; what is under the pointer is told. @param {Scene} s */ function steer(s) {
  const place = s.canvas, tip = byId("tip"), held = /** @type {Map<number, PointerEvent>} */ (new Map());
  let moved = 0;
  const shift = (/** @type {number} */ dx, /** @type {number} */ dy) => {
    const [right, up] = s.axes(), metre = 1 / s.scaleAt(s.target);
    s.target = add(s.target, add(times(right, -dx * metre), times(up, dy * metre)));
    state.follow = byId("follow").checked = false;
  };
  const orbit = (/** @type {number} */ dx, /** @type {number} */ dy) => { s.azimuth -= dx * 0.008; s.elevation = Math.min(1.57, Math.max(-0.4, s.elevation + dy * 0.008)); };
  const zoom = (/** @type {number} */ by) => { s.distance = Math.min(8 * s.reach, Math.max(1e-3 * s.reach, s.distance * by)); };
  /** The nearest sample of the run, a waypoint or an obstacle. @param {number} x @param {number} y */ const under = (x, y) => {
    const c = caseOf(state.index), f = c.flown, near = { d: 14, t: NaN, text: "" };
    const look = (/** @type {V3} */ p, /** @type {number} */ t, /** @type {() => string} */ text, bonus = 0) => {
      const at = s.project(lifted(p)), d = at ? Math.hypot(at[0] - x, at[1] - y) - bonus : Infinity;
      if (d < near.d) Object.assign(near, { d, t, text: text() });
    };
    if (f) f.p.forEach((p, i) => look(p, f.t[i], () => `t = ${f.t[i].toFixed(2)} s, deviation ${fixed(f.d[i])} ${data.unit}`));
    c.data.waypoints.forEach((p, i) => look(p, NaN, () => `waypoint ${i} (${p.map(fixed).join(", ")}) m`, 4));
    if (near.text) return near;
    const [right, up, back] = s.axes(), k = 2 * SPAN / s.height;
    const way = sub(add(times(right, (x - s.width / 2) * k), times(up, (s.height / 2 - y) * k)), back);
    const hit = built.targets.map((o) => ({ ...near, name: o.name, first: meets(s.eye(), way, o.xyz, o.t) })).sort((a, b) => a.first - b.first)[0];
    return hit && hit.first < Infinity ? { ...near, text: hit.name } : near;
  };
  place.addEventListener("pointerdown", (event) => { place.setPointerCapture(event.pointerId); held.set(event.pointerId, event); moved = 0; });
  place.addEventListener("pointermove", (event) => {
    const before = held.get(event.pointerId), box = place.getBoundingClientRect();
    if (!before) {
      const { text } = under(event.clientX - box.left, event.clientY - box.top);
      [tip.textContent, tip.hidden] = [text, !text];
      return;
    }
    const [dx, dy] = [event.clientX - before.clientX, event.clientY - before.clientY], other = [...held.values()].find((one) => one.pointerId !== event.pointerId);
    moved += Math.abs(dx) + Math.abs(dy);
    if (other) {
      const span = (/** @type {PointerEvent} */ one) => Math.hypot(one.clientX - other.clientX, one.clientY - other.clientY) || 1;
      zoom(span(before) / span(event));
      shift(dx / 2, dy / 2);
    } else if (event.shiftKey || event.buttons & 6) shift(dx, dy); else orbit(dx, dy);
    held.set(event.pointerId, event);
    request();
  });
  for (const name of ["pointerup", "pointercancel"]) place.addEventListener(name, (event) => {
    const { pointerId, clientX, clientY } = /** @type {PointerEvent} */ (event), box = place.getBoundingClientRect();
    if (held.delete(pointerId) && name === "pointerup" && moved < 4) { const { t } = under(clientX - box.left, clientY - box.top); if (!Number.isNaN(t)) seek(t); }
  });
  place.addEventListener("pointerleave", () => { tip.hidden = true; }); place.addEventListener("contextmenu", (event) => event.preventDefault());
  place.addEventListener("wheel", (event) => { event.preventDefault(); zoom(Math.exp(event.deltaY * 0.0012)); request(); }, { passive: false });
  /** @type {{ [key: string]: (shifted: boolean) => void }} */ const keys = {
    ArrowLeft: (shifted) => (shifted ? shift(30, 0) : orbit(-20, 0)), ArrowRight: (shifted) => (shifted ? shift(-30, 0) : orbit(20, 0)),
    ArrowUp: (shifted) => (shifted ? shift(0, 30) : orbit(0, 20)), ArrowDown: (shifted) => (shifted ? shift(0, -30) : orbit(0, -20)),
    "+": () => zoom(0.8), "=": () => zoom(0.8), "-": () => zoom(1.25), 0: () => fit(), t: () => fit(-Math.PI / 2, 1.57), s: () => fit(-Math.PI / 2, 0),
    " ": () => playing(!state.playing), ",": () => seek(state.t - 0.1), ".": () => seek(state.t + 0.1), w: () => seek(caseOf(state.index).data.at),
    n: () => select(state.index + 1), p: () => select(state.index - 1), f: () => byId("follow").click(), g: () => byId("ghost").click(),
  };
  place.addEventListener("keydown", (event) => {
    const act = keys[event.key];
    if (!act || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault(); act(event.shiftKey); request();
  });
}

function listen() {
  every("table.cases thead th").forEach((header, column) => header.firstElementChild?.addEventListener("click", () => sortBy(column, header)));
  document.addEventListener("click", (event) => {
    const at = /** @type {HTMLElement} */ (event.target), button = /** @type {HTMLElement | null} */ (at.closest("button[data-verb]")), row = /** @type {HTMLElement | null} */ (at.closest("tr.shown"));
    if (button) copy(button); else if (row) { select(data.cases.findIndex((c) => c.id === row.dataset.case)); show(); }
  });
  const on = (/** @type {string} */ id, /** @type {string} */ what, /** @type {(element: any) => void} */ act) => byId(id)?.addEventListener(what, () => act(byId(id)));
  for (const id of ["across", "upward"]) on(id, "change", drawChosen);
  on("all-cases", "click", () => choose(null));
  if (!data.cases.length) return;
  on("pick", "change", (e) => select(Number(e.value)));
  for (const [id, by] of /** @type {[string, number][]} */ ([["before", -1], ["after", 1]])) on(id, "click", () => select(state.index + by));
  on("time", "input", (e) => seek(Number(e.value)));
  on("worst-moment", "click", () => seek(caseOf(state.index).data.at));
  on("play", "click", () => playing(!state.playing));
  on("speed", "change", (e) => { state.speed = Number(e.value); });
  on("fit", "click", () => fit()); on("png", "click", picture);
  for (const [id, up] of /** @type {[string, number][]} */ ([["from-above", 1.57], ["from-side", 0]])) on(id, "click", () => fit(-Math.PI / 2, up));
  on("ghost", "change", (e) => { state.ghost = e.checked; request(); });
  on("follow", "change", (e) => { state.follow = e.checked; if (scene && e.checked && data.robot) scene.distance = Math.min(scene.distance, 9 * data.robot.radius); request(); });
  on("high", "change", (e) => { state.high = Number(e.value); build(); fit(); });
  addEventListener("hashchange", () => { const index = data.cases.findIndex((c) => "#" + c.id === location.hash); if (index >= 0 && index !== state.index) select(index); });
}
/** All that is drawn in the page's colours and to its width. */
function redraw() {
  readTheme();
  if (data.cases.length) { build(); cursor = drawSeries(byId("series"), caseOf(state.index), data, seek); seek(state.t); }
  if (metrics.length) { drawShare(byId("share"), metrics[0]); drawChosen(); }
}
function start() {
  readTheme();
  listen();
  if (data.cases.length) {
    try {
      scene = new Scene(byId("gl"), byId("ink"));
      steer(scene);
      for (const [link, { mesh }] of (data.robot ? data.robot.links : []).entries()) for (const one of mesh) built.robot.push({ mesh: scene.mesh(decode(one.v), decode(one.t)), link });
    } catch (error) {
      byId("space").textContent = `This picture cannot be drawn here (${error instanceof Error ? error.message : error}); top and side view are below.`;
    }
    const asked = data.cases.findIndex((c) => c.id === (data.asked ?? location.hash.slice(1))); // a page within another one has no address: it asks by the data
    select(asked >= 0 ? asked : data.open, true);
  }
  if (metrics.length) drawShare(byId("share"), metrics[0]);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  let width = innerWidth;
  addEventListener("resize", () => { if (innerWidth !== width) { width = innerWidth; redraw(); } });
}
try { start(); } finally { requestAnimationFrame(() => requestAnimationFrame(() => { root.dataset.ready = "1"; })); }
