// Light charts as SVG: curves over time, bars of a distribution, the share over a limit, and dots of two measures.

/** @param {string} tag @param {{ [name: string]: string | number }} attributes @param {Element} [parent] @param {string} [text] @returns {SVGElement} */
function svg(tag, attributes, parent, text) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, typeof value === "number" ? String(Math.round(value * 100) / 100) : value);
  if (text !== undefined) element.textContent = text;
  parent?.append(element);
  return element;
}

/** Round numbers between two others, about `most` of them. @param {number} low @param {number} high @param {number} most */ function ticks(low, high, most) {
  const span = high - low || 1, raw = span / Math.max(1, most), ten = 10 ** Math.floor(Math.log10(raw));
  const step = ten * ([1, 2, 5, 10].find((s) => s * ten >= raw) || 10), found = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * span; i++) found.push(i * step);
  return found;
}

/** As people write it: three digits, no zeros behind, no exponent where there need be none. @param {number | null | undefined} value */ function short(value) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  const size = Math.abs(value);
  if (size < 1e-9) return "0";
  return String(Number(value.toFixed(Math.min(9, Math.max(0, 2 - Math.floor(Math.log10(size)))))));
}
/** With the digits that verdicts have: of the limit, or as many as it takes to see that it differs from it, or from nothing. @param {number} value */
function fixed(value) {
  const { digits, limit } = data, shows = Math.abs(value) < 5e-6 || Number(value.toFixed(digits)) !== 0;
  let n = shows ? digits : 1 - Math.floor(Math.log10(Math.abs(value)));
  while (n < 7 && limit !== null && value.toFixed(n) === limit.toFixed(n) && value !== limit) n++;
  return Number.isNaN(value) ? "–" : value.toFixed(n);
}
/** A limit as it was given. @param {number} value */
const given = (value) => (/\.\d{2}/.test(String(value)) ? String(value) : value.toFixed(2));

/** @param {ArrayLike<number>} values */ function range(values) {
  let [low, high] = [Infinity, -Infinity];
  for (let i = 0; i < values.length; i++) if (!Number.isNaN(values[i])) { low = Math.min(low, values[i]); high = Math.max(high, values[i]); }
  return low <= high ? [low, high] : [0, 1];
}

class Plot {
  /** A frame with both axes. @param {Element} parent @param {number} width @param {number} height @param {{ x: [number, number], y: [number, number], xName: string, yName: string, bare?: boolean, title?: string }} of */
  constructor(parent, width, height, of) {
    this.svg = svg("svg", { class: "chart", viewBox: `0 0 ${width} ${height}`, width, height, role: "img", "aria-label": of.title || `${of.yName} over ${of.xName}` }, parent);
    this.left = 46; this.right = width - 10; this.top = of.yName ? 20 : 8; this.bottom = height - (of.bare ? 6 : 34);
    this.x = this.scale(of.x, this.left, this.right);
    this.y = this.scale(of.y, this.bottom, this.top);
    for (const v of ticks(of.y[0], of.y[1], (this.bottom - this.top) / 34)) {
      svg("line", { class: "grid", x1: this.left, x2: this.right, y1: this.y(v), y2: this.y(v) }, this.svg);
      svg("text", { class: "tick", x: this.left - 6, y: this.y(v) + 4, "text-anchor": "end" }, this.svg, short(v));
    }
    for (const v of ticks(of.x[0], of.x[1], (this.right - this.left) / 70)) {
      svg("line", { class: "grid", x1: this.x(v), x2: this.x(v), y1: this.top, y2: this.bottom }, this.svg);
      if (!of.bare) svg("text", { class: "tick", x: this.x(v), y: this.bottom + 15, "text-anchor": "middle" }, this.svg, short(v));
    }
    if (!of.bare) svg("text", { class: "axis", x: (this.left + this.right) / 2, y: height - 4, "text-anchor": "middle" }, this.svg, of.xName);
    svg("text", { class: "axis", x: 2, y: 12 }, this.svg, of.yName);
  }

  /** @param {[number, number]} of @param {number} from @param {number} to */
  scale([low, high], from, to) { return (/** @type {number} */ v) => from + (to - from) * (v - low) / (high - low || 1); }

  /** A curve, with holes where a value is none. @param {ArrayLike<number>} xs @param {ArrayLike<number>} ys @param {string} look */ curve(xs, ys, look) {
    let d = "", pen = "M";
    for (let i = 0; i < xs.length; i++) if (Number.isNaN(ys[i])) pen = "M"; else { d += pen + this.x(xs[i]).toFixed(1) + " " + this.y(ys[i]).toFixed(1); pen = "L"; }
    if (d) svg("path", { class: "curve " + look, d }, this.svg);
  }

  /** @param {number} value @param {boolean} upright @param {string} look @param {string} [text] */ rule(value, upright, look, text) {
    const at = upright ? this.x(value) : this.y(value);
    svg("line", upright ? { class: look, x1: at, x2: at, y1: this.top, y2: this.bottom } : { class: look, x1: this.left, x2: this.right, y1: at, y2: at }, this.svg);
    // Above the frame, where there is no curve.
    if (text) svg("text", { class: "said", x: this.right, y: 12, "text-anchor": "end" }, this.svg, text);
  }
}

/** Panels over time, one below the other; returns what moves their cursor. @param {HTMLElement} place @param {Case} c @param {ReportDataOfPage} data @param {(t: number) => void} seek @returns {(t: number) => void} */
function drawSeries(place, c, data, seek) {
  place.textContent = "";
  const f = c.flown;
  if (!f || !c.data.flown) { place.textContent = "Nothing was " + data.done + ": there is no curve."; return () => {}; }
  const width = Math.max(280, place.clientWidth), x = /** @type {[number, number]} */ ([f.t[0], f.t[f.t.length - 1]]);
  const judged = f.d.map((d, i) => (f.judged[i] ? d : NaN));
  // A stretch inside a corner keeps the samples that it shares with the judged ones, so that the line has no holes.
  const corner = f.d.map((d, i) => (!f.judged[i] || f.judged[i - 1] === 0 || f.judged[i + 1] === 0 ? d : NaN));
  /** @typedef {{ name: string, look: string, t: ArrayLike<number>, y: ArrayLike<number> }} Curve */
  /** @type {{ title: string, curves: Curve[], limit: number | null, zero: boolean }[]} */
  const panels = [{ title: `deviation ${data.unit}`, limit: data.limit, zero: true, curves: [
    ...c.runs.map((run, i) => ({ name: i ? "" : data.beside, look: "other", t: run.t, y: run.d })),
    ...(f.judged.includes(0) ? [{ name: "in corners (overshoot judges)", look: "corner", t: f.t, y: corner }] : []),
    { name: data.shown, look: "flown", t: f.t, y: judged },
  ] }, { title: "speed m/s", limit: null, zero: true, curves: [{ name: "", look: "plan", t: f.t, y: f.v }] }];
  for (const { title, lines } of c.data.flown.panels) {
    panels.push({ title, limit: null, zero: false, curves: lines.map((l, i) => ({ name: l.name, look: "c" + (i % 6), t: f.t, y: f.channels[l.channel].map((v) => v * l.scale) })) });
  }
  /** @type {{ plot: Plot, cursor: SVGElement }[]} */ const drawn = panels.map(({ title, curves, limit, zero }, i) => {
    const named = curves.filter((curve) => curve.name);
    if (named.length > 1) {
      const keys = place.appendChild(document.createElement("p"));
      keys.className = "keys";
      for (const { name, look } of named) {
        const key = document.createElement("span");
        key.className = "named";
        svg("path", { class: "curve " + look, d: "M1 5H25" }, svg("svg", { width: 26, height: 10, "aria-hidden": "true" }, key));
        key.append(" " + name);
        keys.append(key, " ");
      }
    }
    let [low, high] = range(curves.flatMap(({ y }) => range(y)).concat(limit === null ? [] : [limit]));
    if (zero) low = Math.min(0, low);
    const room = (high - low || 1) * 0.08, last = i === panels.length - 1;
    const y = /** @type {[number, number]} */ ([zero ? low : low - room, high + room]);
    const plot = new Plot(place, width, (i ? 110 : 170) + (last ? 28 : 0), { x, y, xName: "t s", yName: title, bare: !last });
    for (const curve of curves) plot.curve(curve.t, curve.y, curve.look);
    if (limit !== null) plot.rule(limit, false, "limit", "limit " + given(limit) + " " + data.unit);
    plot.rule(c.data.at, true, "moment");
    const cursor = svg("line", { class: "cursor", y1: plot.top, y2: plot.bottom }, plot.svg);
    const move = (/** @type {PointerEvent} */ event) => {
      if (event.type === "pointermove" && !event.buttons) return;
      const box = plot.svg.getBoundingClientRect(), share = ((event.clientX - box.left) / box.width * width - plot.left) / (plot.right - plot.left);
      seek(x[0] + Math.min(1, Math.max(0, share)) * (x[1] - x[0]));
    };
    plot.svg.addEventListener("pointerdown", move); plot.svg.addEventListener("pointermove", move);
    return { plot, cursor };
  });
  return (t) => drawn.forEach(({ plot, cursor }) => { cursor.setAttribute("x1", String(plot.x(t))); cursor.setAttribute("x2", String(plot.x(t))); });
}

/** @typedef {{ name: string, unit: string, limit: number | null, lower: boolean, values: Float64Array, random: Float64Array | null }} Metric */
/** @typedef {(chosen: number[], why: string) => void} Choose */

/** Bars of one measure, the cases by chance beside them; a bar chooses its cases. @param {HTMLElement} place @param {Metric} m @param {Set<number> | null} chosen @param {Choose} choose */
function drawBars(place, m, chosen, choose) {
  const width = Math.max(240, Math.min(place.clientWidth, 400)), random = m.random;
  const all = [...m.values, ...(random || []), ...(m.limit === null ? [] : [m.limit])];
  let [low, high] = range(all);
  if (high - low < 1e-12) [low, high] = [low - 0.5, high + 0.5];
  const count = Math.max(6, Math.min(24, Math.ceil(Math.sqrt(m.values.length) * 1.5))), step = (high - low) / count;
  const bin = (/** @type {number} */ v) => Math.min(count - 1, Math.max(0, Math.floor((v - low) / step)));
  const cells = /** @type {number[][]} */ (Array.from({ length: count }, () => [])), beside = new Array(count).fill(0);
  m.values.forEach((v, i) => { if (!Number.isNaN(v)) cells[bin(v)].push(i); });
  (random || []).forEach((v) => { if (!Number.isNaN(v)) beside[bin(v)]++; });
  const n = cells.reduce((sum, cell) => sum + cell.length, 0) || 1, k = beside.reduce((sum, v) => sum + v, 0) || 1;
  const share = (/** @type {number} */ v, /** @type {number} */ of) => (random ? 100 * v / of : v);
  const top = Math.max(...cells.map((cell) => share(cell.length, n)), ...(random ? beside.map((v) => share(v, k)) : [])) * 1.06 || 1;
  const name = `${m.name}${m.unit ? " " + m.unit : ""}`;
  const plot = new Plot(place, width, 176, { x: [low, high], y: [0, top], xName: name, yName: random ? "% of cases" : "cases", title: "Distribution of " + name });
  cells.forEach((cell, i) => {
    const [x1, x2] = [plot.x(low + i * step), plot.x(low + (i + 1) * step)], wide = random ? (x2 - x1) * 0.52 : x2 - x1 - 1;
    const bar = (/** @type {string} */ look, /** @type {number} */ value, /** @type {number} */ x) => svg("rect", { class: look, x, width: Math.max(1, wide), y: plot.y(value), height: plot.bottom - plot.y(value) }, plot.svg);
    if (beside[i]) bar("bar random", share(beside[i], k), x2 - wide - 0.5);
    if (!cell.length) return;
    const words = `${short(low + i * step)} to ${short(low + (i + 1) * step)} ${m.unit}`, one = bar("bar", share(cell.length, n), x1 + 0.5);
    const inside = chosen ? cell.filter((c) => chosen.has(c)).length : 0;
    if (inside) bar("bar chosen", share(inside, n), x1 + 0.5);
    const hit = svg("rect", { class: "hit", x: x1, width: x2 - x1, y: plot.top, height: plot.bottom - plot.top, tabindex: 0, role: "button", "aria-label": `${cell.length} cases with ${m.name} ${words}` }, plot.svg);
    svg("title", {}, hit, `${m.name} ${words}: ${cell.length} cases`);
    one.setAttribute("data-cases", String(cell.length));
    press(hit, () => choose(cell, `${m.name} ${words}`));
  });
  if (m.limit !== null) plot.rule(m.limit, true, "limit", (m.lower ? "at least " : "limit ") + given(m.limit));
}

/** Share of cases that are over each possible limit: a falling staircase. @param {HTMLElement} place @param {Metric} m */ function drawShare(place, m) {
  place.textContent = "";
  const known = [...m.values].filter((v) => !Number.isNaN(v)).sort((a, b) => a - b), n = known.length || 1;
  const random = m.random && [...m.random].filter((v) => !Number.isNaN(v)).sort((a, b) => a - b);
  const high = Math.max(range(known.concat(random || []))[1], m.limit || 0) * 1.04 || 1;
  const plot = new Plot(place, Math.max(280, place.clientWidth), 230, { x: [0, high], y: [0, 104], xName: `limit of the ${m.name} ${m.unit}`, yName: "% of cases over it" });
  const stairs = (/** @type {number[]} */ sorted, /** @type {string} */ look) => {
    const xs = [0], ys = [100];
    sorted.forEach((v, i) => { xs.push(v, v); ys.push(ys[ys.length - 1], 100 * (sorted.length - 1 - i) / sorted.length); });
    plot.curve([...xs, high], [...ys, ys[ys.length - 1]], look);
  };
  if (random && random.length) stairs(random, "other");
  stairs(known, "flown");
  const limit = m.limit;
  if (limit !== null) plot.rule(limit, true, "limit", `limit ${given(limit)} ${m.unit}: ${short(100 * known.filter((v) => v > limit).length / n)} % over it`);
}

/** Dots of two measures; one opens its case. @param {HTMLElement} place @param {{ name: string, values: Float64Array }} a @param {{ name: string, values: Float64Array }} b @param {{ ids: string[], fails: (i: number) => boolean, chosen: Set<number> | null, current: number, open: (i: number) => void }} of */
function drawScatter(place, a, b, of) {
  place.textContent = "";
  const pad = (/** @type {number[]} */ [low, high]) => /** @type {[number, number]} */ ([low - (high - low || 1) * 0.05, high + (high - low || 1) * 0.05]);
  const plot = new Plot(place, Math.max(280, place.clientWidth), 320, { x: pad(range(a.values)), y: pad(range(b.values)), xName: a.name, yName: b.name });
  of.ids.forEach((id, i) => {
    if (Number.isNaN(a.values[i]) || Number.isNaN(b.values[i])) return;
    const [x, y] = [plot.x(a.values[i]), plot.y(b.values[i])], dim = of.chosen && !of.chosen.has(i) ? " dim" : "", here = i === of.current ? " here" : "";
    // Shape tells as well as colour: a square violates.
    const dot = of.fails(i) ? svg("rect", { class: "dot fails" + dim + here, x: x - 4, y: y - 4, width: 8, height: 8 }, plot.svg) : svg("circle", { class: "dot" + dim + here, cx: x, cy: y, r: 4 }, plot.svg);
    for (const [name, value] of [["tabindex", "0"], ["role", "button"], ["aria-label", "case " + id]]) dot.setAttribute(name, value);
    svg("title", {}, dot, `${id}: ${a.name} ${short(a.values[i])}, ${b.name} ${short(b.values[i])}`);
    press(dot, () => of.open(i));
  });
}

/** By mouse and by keyboard. @param {Element} element @param {() => void} act */ function press(element, act) {
  element.addEventListener("click", act);
  element.addEventListener("keydown", (event) => {
    const { key } = /** @type {KeyboardEvent} */ (event);
    if (key === "Enter" || key === " ") { event.preventDefault(); act(); }
  });
}
