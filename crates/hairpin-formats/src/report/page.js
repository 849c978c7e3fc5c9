"use strict";
// Draws what the page's JSON holds. Without WebGL the 3D view says so, and everything else still works.
(() => {
  const root = document.documentElement;
  const data = JSON.parse(document.getElementById("data").textContent);
  const byId = (id) => document.getElementById(id);
  const INK = "#1b2733", SOFT = "#5b6b7a", LINE = "#dde4ea", PLAN = "#0b6ea8", FLOWN = "#b5400d";
  // Lightness falls all along, so the order is seen without colours as well.
  const SCALE = [[0, "#9ccbe3"], [0.3, "#5a8fca"], [0.6, "#7d4aa5"], [0.8, "#a3285f"], [1, "#7a0c12"]];
  const ROTORS = ["#0b6ea8", "#b5400d", "#5f8a00", "#6a4c93", "#806000", "#1b2733"];
  const DASHES = ["solid", "dash", "dot", "dashdot", "longdash", "longdashdot"];
  const FONT = { family: "system-ui, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif", size: 13, color: INK };
  const CONFIG = { displaylogo: false, responsive: true, modeBarButtonsToRemove: ["select2d", "lasso2d", "sendDataToCloud"] };
  const fixed = (value, digits) => (value === null || value === undefined ? "–" : value.toFixed(digits));
  const base = (more) => Object.assign({ font: FONT, paper_bgcolor: "#fff", plot_bgcolor: "#fff", hovermode: "closest", showlegend: true }, more);
  const axis = (title, more) => Object.assign({ title: { text: title, standoff: 8 }, gridcolor: "#edf1f4", zerolinecolor: LINE, linecolor: LINE, automargin: true }, more);
  const DONE = data.relief ? "driven" : "flown";
  let current = 0, sample = 0, spatial = true;

  root.dataset.js = "1";

  // A plot that cannot be drawn must not take the others with it.
  const attempt = (id, draw) => Promise.resolve().then(draw).catch((error) => {
    byId(id).textContent = "This view cannot be drawn here (" + error.message + ").";
  });

  function hasWebGl() {
    const canvas = document.createElement("canvas");
    return Boolean(canvas.getContext("webgl") || canvas.getContext("experimental-webgl"));
  }

  function cage() {
    const [x, y, z] = data.size, [u, v, w] = data.low, xs = [], ys = [], zs = [];
    const edge = (a, b) => { xs.push(u + a[0], u + b[0], null); ys.push(v + a[1], v + b[1], null); zs.push(w + a[2], w + b[2], null); };
    for (const s of [0, 1]) for (const t of [0, 1]) {
      edge([0, s * y, t * z], [x, s * y, t * z]);
      edge([s * x, 0, t * z], [s * x, y, t * z]);
      edge([s * x, t * y, 0], [s * x, t * y, z]);
    }
    return { type: "scatter3d", mode: "lines", x: xs, y: ys, z: zs, line: { color: "#b8c4ce", width: 2 }, hoverinfo: "skip", name: "world", showlegend: false };
  }

  // Shaded ground: grey as light falls on it, so that the paths' colours stay the only ones.
  function ground() {
    const r = data.relief, at = (low, n) => Array.from({ length: n }, (_, i) => low + i * r.step);
    return { type: "surface", x: at(r.low[0], r.z[0].length), y: at(r.low[1], r.z.length), z: r.z, surfacecolor: r.shade, cmin: 0, cmax: 1, colorscale: [[0, "#5c564f"], [1, "#fbf8f2"]], showscale: false, name: "ground", lighting: { ambient: 1, diffuse: 0, specular: 0 }, hovertemplate: "(%{x:.2f}, %{y:.2f}, %{z:.2f}) m<extra>ground</extra>", contours: { x: { highlight: false }, y: { highlight: false }, z: { highlight: false } } };
  }

  function scene(c) {
    const traces = [data.relief ? ground() : cage()];
    for (const o of data.obstacles.concat(c.obstacles)) traces.push({ type: "mesh3d", x: o.x, y: o.y, z: o.z, i: o.i, j: o.j, k: o.k, color: "#9aa7b3", opacity: 0.55, flatshading: true, hoverinfo: "name", name: o.name });
    traces.push({ type: "scatter3d", mode: "lines", x: c.planned.x, y: c.planned.y, z: c.planned.z, name: "planned", line: { color: PLAN, width: 4, dash: "dash" }, hoverinfo: "skip" });
    const w = c.waypoints;
    traces.push({ type: "scatter3d", mode: "markers+text", name: "waypoints", x: w.map((p) => p[0]), y: w.map((p) => p[1]), z: w.map((p) => p[2]), text: w.map((_, i) => String(i)), textposition: "top center", textfont: { size: 14, color: INK }, marker: { size: 4, color: INK }, hovertemplate: "waypoint %{text}<br>(%{x:.2f}, %{y:.2f}, %{z:.2f}) m<extra></extra>" });
    const f = c.flown;
    if (f) {
      const top = Math.max(...f.d, data.limit || 0, 1e-9);
      traces.push({
        type: "scatter3d", mode: "lines", name: DONE, x: f.x, y: f.y, z: f.z, customdata: f.t.map((t, i) => [t, f.d[i]]),
        line: { width: 7, color: f.d, colorscale: SCALE, cmin: 0, cmax: top, showscale: true, colorbar: { title: { text: "deviation m", side: "right" }, thickness: 14, len: 0.7, outlinewidth: 0 } },
        hovertemplate: "t = %{customdata[0]:.2f} s<br>deviation %{customdata[1]:.2f} m<br>(%{x:.2f}, %{y:.2f}, %{z:.2f}) m<extra></extra>",
      });
      if (c.worst) {
        const i = nearest(f.t, c.worst.t);
        traces.push({ type: "scatter3d", mode: "markers", name: "worst moment", x: [f.x[i]], y: [f.y[i]], z: [f.z[i]], marker: { size: 13, color: INK, symbol: "circle-open", line: { color: INK, width: 3 } }, hovertemplate: "worst: " + fixed(c.worst.d, 2) + " m at t = " + fixed(c.worst.t, 2) + " s<extra></extra>" });
      }
      traces.push({ type: "scatter3d", mode: "markers", name: "now", x: [f.x[0]], y: [f.y[0]], z: [f.z[0]], marker: { size: 7, color: "#f0a202", line: { color: INK, width: 1 } }, hoverinfo: "skip" });
    }
    return traces;
  }

  const nearest = (times, t) => {
    let best = 0;
    for (let i = 1; i < times.length; i++) if (Math.abs(times[i] - t) < Math.abs(times[best] - t)) best = i;
    return best;
  };

  function drawSpace(c) {
    if (!spatial) throw new Error("the browser has no WebGL; top and side view are below");
    const ax = (name, size) => ({ title: { text: name + " m" }, range: range(name, size), backgroundcolor: "#fbfcfd", gridcolor: LINE, showbackground: true, zeroline: false, color: SOFT });
    const paths = ["x", "y", "z"].map((k) => (c.flown ? c.flown[k] : []).concat(c.planned[k]));
    const reach = (k, size) => [Math.min(data.low[k], ...paths[k]), Math.max(data.low[k] + size, ...paths[k])];
    const range = (name, size) => reach("xyz".indexOf(name), size);
    const layout = base({
      margin: { l: 0, r: 0, t: 4, b: 0 }, uirevision: "keep", legend: { orientation: "h", y: 0.01, x: 0.01, bgcolor: "rgba(255,255,255,.75)" },
      scene: { aspectmode: "data", uirevision: "keep", camera: { eye: { x: 1.3, y: -1.45, z: 0.7 }, center: { x: 0, y: 0, z: -0.17 } }, xaxis: ax("x", data.size[0]), yaxis: ax("y", data.size[1]), zaxis: ax("z", data.size[2]) },
    });
    return Plotly.react("space", scene(c), layout, CONFIG);
  }

  function drawSeries(c) {
    const f = c.flown;
    if (!f) throw new Error("the executor failed: nothing was " + DONE);
    const judged = f.d.map((d, i) => (f.judged[i] ? d : null));
    // Each stretch inside a corner keeps the samples that it shares with the judged ones, so the line has no holes.
    const corner = f.d.map((d, i) => (!f.judged[i] || f.judged[i - 1] === 0 || f.judged[i + 1] === 0 ? d : null));
    const line = (y, name, yaxis, color, more) => Object.assign({ type: "scatter", mode: "lines", x: f.t, y, name, yaxis, line: { color, width: 2 }, hovertemplate: "%{y}<extra>" + name + "</extra>" }, more);
    const traces = [line(corner, "in corners (overshoot judges)", "y", "#9aa7b3", { line: { color: "#9aa7b3", width: 1.5, dash: "dot" } }), line(judged, "deviation", "y", FLOWN), line(f.v, "speed", "y2", PLAN)];
    const panels = f.panels || [];
    panels.forEach((panel, p) => panel.lines.forEach((l, i) => traces.push(line(l.y, l.name, "y" + (p + 3), ROTORS[i % 6], { line: { color: ROTORS[i % 6], width: 1.4, dash: DASHES[i % 6] } }))));
    // Deviation and speed on top, the other panels below in equal parts.
    const gap = 0.06, part = 1 / (panels.length + 2.4), from = (k) => Math.max(0, 1 - (k === 0 ? 1.4 : k + 1.4) * part);
    const domain = (k) => [from(k) + (k === panels.length + 1 ? 0 : gap / 2), k === 0 ? 1 : from(k - 1) - gap / 2];
    byId("series").style.height = 200 + 160 * (panels.length + 1) + "px";
    const shapes = [{ type: "line", xref: "x", yref: "paper", x0: f.t[sample], x1: f.t[sample], y0: 0, y1: 1, line: { color: "#f0a202", width: 2 } }];
    if (data.limit !== null) shapes.push({ type: "line", xref: "paper", yref: "y", x0: 0, x1: 1, y0: data.limit, y1: data.limit, line: { color: INK, width: 1.5, dash: "dash" } });
    const notes = data.limit === null ? [] : [{ xref: "paper", yref: "y", x: 1, y: data.limit, xanchor: "right", yanchor: "bottom", text: "limit " + fixed(data.limit, 2) + " m", showarrow: false, font: { size: 12, color: INK } }];
    if (c.worst) notes.push({ x: c.worst.t, y: c.worst.d, xref: "x", yref: "y", text: fixed(c.worst.d, 2) + " m", showarrow: true, arrowhead: 0, ax: 28, ay: -18, font: { size: 12, color: INK }, bgcolor: "rgba(255,255,255,.8)" });
    const top = Math.max(...f.d, data.limit || 0) * 1.15 || 1;
    const layout = base({
      margin: { l: 62, r: 14, t: 8, b: 44 }, hovermode: "x", legend: { orientation: "h", y: 1.09, x: 0 }, shapes, annotations: notes,
      xaxis: axis("t s", { anchor: "y" + (panels.length + 2), range: [f.t[0], f.t[f.t.length - 1]] }),
      yaxis: axis("deviation m", { domain: domain(0), range: [0, top] }),
      yaxis2: axis("speed m/s", { domain: domain(1), rangemode: "tozero" }),
    });
    panels.forEach((panel, p) => { layout["yaxis" + (p + 3)] = axis(panel.title, { domain: domain(p + 2) }); });
    return Plotly.react("series", traces, layout, CONFIG);
  }

  function drawShare() {
    const m = data.metrics[0], v = m.values, n = v.length;
    // Share of cases whose value is over each possible limit: a falling staircase.
    const x = [0].concat(v), y = [100].concat(v.map((_, i) => (100 * (n - 1 - i)) / n));
    const traces = [{ type: "scatter", mode: "lines", line: { shape: "hv", color: FLOWN, width: 2.5 }, x, y, name: "share over the limit", hovertemplate: "limit %{x:.2f} m: %{y:.1f} % over it<extra></extra>", fill: "tozeroy", fillcolor: "rgba(181,64,13,.08)" }];
    const shapes = [], annotations = [];
    if (m.limit !== null) {
      const over = (100 * v.filter((value) => value > m.limit).length) / n;
      shapes.push({ type: "line", xref: "x", yref: "paper", x0: m.limit, x1: m.limit, y0: 0, y1: 1, line: { color: INK, width: 1.5, dash: "dash" } });
      annotations.push({ x: m.limit, y: 1, yref: "paper", text: "limit " + fixed(m.limit, 2) + " m: " + fixed(over, 1) + " % over it", showarrow: false, xanchor: "left", xshift: 6, yanchor: "top" });
    }
    return Plotly.react("share", traces, base({ title: { text: "Share of cases over a limit of the deviation", font: { size: 14 }, x: 0, xanchor: "left", xref: "paper" }, margin: { l: 60, r: 14, t: 40, b: 46 }, showlegend: false, shapes, annotations, xaxis: axis("limit of the " + m.name + " " + m.unit, { rangemode: "tozero" }), yaxis: axis("cases over it %", { range: [0, 103] }) }), CONFIG);
  }

  function drawSpread() {
    const count = data.metrics.length, columns = Math.min(count, 4), rows = Math.ceil(count / columns);
    byId("spread").style.height = 60 + 200 * rows + "px";
    const traces = [], shapes = [], layout = base({ showlegend: false, margin: { l: 44, r: 14, t: 34, b: 44 }, bargap: 0.04, grid: { rows, columns, pattern: "independent", xgap: 0.16, ygap: 0.42 }, title: { text: "Distribution of every measure, one value per case", font: { size: 14 }, x: 0, xanchor: "left", xref: "paper" } });
    data.metrics.forEach((m, i) => {
      const id = i ? String(i + 1) : "";
      traces.push({ type: "histogram", x: m.values, xaxis: "x" + id, yaxis: "y" + id, nbinsx: 24, marker: { color: "#6f9fc4" }, hovertemplate: "%{x} " + m.unit + ": %{y} cases<extra></extra>" });
      layout["xaxis" + id] = axis(m.name + " " + m.unit, {});
      layout["yaxis" + id] = axis("", {});
      if (m.limit !== null) shapes.push({ type: "line", xref: "x" + id, yref: "y" + id + " domain", x0: m.limit, x1: m.limit, y0: 0, y1: 1, line: { color: INK, width: 1.5, dash: "dash" } });
    });
    layout.shapes = shapes;
    return Plotly.react("spread", traces, layout, CONFIG);
  }

  let waiting = false;
  function show(i) {
    const f = data.cases[current].flown;
    if (!f) { byId("moment").textContent = ""; return; }
    sample = Math.max(0, Math.min(i, f.t.length - 1));
    byId("time").value = String(sample);
    const leg = f.leg ? ", leg " + f.leg[sample] + "→" + (f.leg[sample] + 1) : "";
    byId("moment").textContent = "t = " + fixed(f.t[sample], 2) + " s" + leg + ", deviation " + fixed(f.d[sample], 2) + " m, " + fixed(f.v[sample], f.v[sample] < 1 ? 2 : 1) + " m/s";
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      const g = data.cases[current].flown, s = Math.min(sample, g ? g.t.length - 1 : 0);
      if (!g) return;
      const space = byId("space");
      if (space.data) Plotly.restyle(space, { x: [[g.x[s]]], y: [[g.y[s]]], z: [[g.z[s]]] }, [space.data.length - 1]);
      if (byId("series").data) Plotly.relayout("series", { "shapes[0].x0": g.t[s], "shapes[0].x1": g.t[s] });
    });
  }

  const worstSample = (c) => (c.flown && c.worst ? nearest(c.flown.t, c.worst.t) : 0);

  async function select(index) {
    current = Math.max(0, Math.min(index, data.cases.length - 1));
    const c = data.cases[current];
    byId("case-id").textContent = c.id;
    byId("pick").value = String(current);
    byId("before").disabled = current === 0;
    byId("after").disabled = current === data.cases.length - 1;
    for (const part of document.querySelectorAll("figure.case, .findings")) part.hidden = part.dataset.case !== c.id;
    for (const row of document.querySelectorAll("tr[data-case]")) row.setAttribute("aria-selected", String(row.dataset.case === c.id));
    byId("time").max = String(c.flown ? c.flown.t.length - 1 : 0);
    byId("time").disabled = !c.flown;
    sample = worstSample(c);
    for (const id of ["space", "series"]) if (byId(id).data === undefined) byId(id).textContent = "";
    if (!c.flown) Plotly.purge("series");
    await attempt("space", () => drawSpace(c));
    await attempt("series", () => drawSeries(c));
    show(sample);
  }

  function sortBy(column, header) {
    const body = header.closest("table").tBodies[0], rows = [...body.rows];
    const falling = header.getAttribute("aria-sort") !== "descending";
    for (const other of header.parentNode.cells) other.setAttribute("aria-sort", "none");
    header.setAttribute("aria-sort", falling ? "descending" : "ascending");
    const key = (row) => {
      const text = row.cells[column].textContent.trim(), value = parseFloat(text);
      return text === "–" ? null : Number.isNaN(value) ? text : value;
    };
    rows.sort((a, b) => {
      const [p, q] = [key(a), key(b)];
      if (p === null || q === null) return (p === null) - (q === null);
      const order = typeof p === "number" && typeof q === "number" ? p - q : String(p).localeCompare(String(q));
      return falling ? -order : order;
    });
    body.append(...rows);
  }

  function listen() {
    document.querySelectorAll("table.cases thead th").forEach((header, column) => header.firstElementChild.addEventListener("click", () => sortBy(column, header)));
    for (const row of document.querySelectorAll("tr.shown")) row.addEventListener("click", () => {
      select(Number(row.querySelector("button").dataset.index));
      byId("flight").scrollIntoView({ behavior: matchMedia("(prefers-reduced-motion: reduce)").matches ? "auto" : "smooth" });
    });
    if (!data.cases.length) return;
    byId("pick").addEventListener("change", (event) => select(Number(event.target.value)));
    byId("before").addEventListener("click", () => select(current - 1));
    byId("after").addEventListener("click", () => select(current + 1));
    byId("time").addEventListener("input", (event) => show(Number(event.target.value)));
    byId("worst-moment").addEventListener("click", () => show(worstSample(data.cases[current])));
  }

  async function start() {
    listen();
    spatial = hasWebGl();
    // Whoever shows the page in another one may ask for a case.
    if (data.cases.length) await select(data.cases.findIndex((c) => c.id === data.open));
    if (data.metrics.length) {
      await attempt("share", drawShare);
      await attempt("spread", drawSpread);
    }
  }
  start().finally(() => { root.dataset.ready = "1"; });
})();
