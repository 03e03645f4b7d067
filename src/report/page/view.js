// The structure in space: WebGL, no library, nothing loaded. Turns, colours, plays the
// softest motion, builds up step by step, and links parts with their places on sheets.
"use strict";
(() => {
  const by = (id) => document.getElementById(id);
  const source = by("scene");
  const all = (part) => document.querySelectorAll(`[data-part="${CSS.escape(part)}"]`);
  const scene = source ? JSON.parse(source.textContent) : { nodes: [], fins: [], parts: [] };
  const { nodes, parts } = scene;
  // Plates of connectors are drawn like fins: four corners, no planarity, no bend.
  const plates = scene.plates || [], finCount = scene.fins.length;
  const fins = [...scene.fins, ...plates.map(([part, node]) => [node, node, part, 0, 0, 0, 0, 0])];
  const state = { part: -1, turn: __AROUND__, tilt: __UP__, zoom: 1, pan: [0, 0], step: parts.length, playing: false, sway: 0, lift: 0 };

  // ---- linking: a part is chosen anywhere and shown everywhere
  const index = new Map(parts.map((part, k) => [part.id, k]));
  const mark = (part, name, on) => part >= 0 && all(parts[part].id).forEach((e) => e.classList.toggle(name, on));
  function choose(part) {
    mark(state.part, "chosen", false);
    state.part = part;
    mark(part, "chosen", true);
    const about = by("about");
    if (about && part >= 0) about.textContent = words(part);
    if (about) place(part);
    draw();
  }
  function words(part) {
    const own = fins.filter((fin) => fin[2] === part).length;
    const { id, sheet } = parts[part];
    const on = sheet == null ? "on no sheet" : `on sheet ${sheet + 1}`;
    const what = plates.some((plate) => plate[0] === part) ? "plates" : own === 1 ? "fin" : "fins";
    return `Part ${id}: step ${part + 1}, ${own} ${what}, ${on}.`;
  }
  function place(part) {
    const small = by("place"), sheet = part >= 0 ? parts[part].sheet : null;
    const drawn = sheet == null ? null : document.querySelectorAll(".sheet svg")[sheet];
    small.toggleAttribute("hidden", !drawn);
    if (!drawn) return;
    small.setAttribute("viewBox", drawn.getAttribute("viewBox"));
    small.setAttribute("aria-label", `place of ${parts[part].id} on its sheet`);
    small.firstElementChild.setAttribute("href", `#${drawn.firstElementChild.id}`);
  }
  for (const element of document.querySelectorAll("[data-part]")) {
    const part = index.get(element.dataset.part);
    if (part === undefined) continue;
    element.addEventListener("click", () => choose(part));
    element.addEventListener("mouseenter", () => mark(part, "near", true));
    element.addEventListener("mouseleave", () => mark(part, "near", false));
    element.addEventListener("keydown", (event) => {
      if (event.key === "Enter" || event.key === " ") { event.preventDefault(); choose(part); }
    });
  }
  for (const when of ["beforeprint", "afterprint"]) {
    addEventListener(when, () => document.querySelectorAll("details").forEach((d) => { d.open = when === "beforeprint"; }));
  }

  const canvas = by("view");
  window.finwright = { state, choose, project: () => null };
  if (!canvas) return;
  const gl = canvas.getContext("webgl", { antialias: true, preserveDrawingBuffer: true });
  if (!gl) {
    canvas.replaceWith("This browser has no WebGL; the pictures of the steps show the structure.");
    return;
  }

  // ---- corners: per fin two triangles and four edges; per corner place, motion, axis
  const xyz = (node, top) => nodes[node].slice(top ? 3 : 0, top ? 6 : 3);
  const minus = (a, b) => a.map((x, k) => x - b[k]);
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const unit = (a) => { const l = Math.hypot(...a) || 1; return a.map((x) => x / l); };
  // Corners of fin f: bottom and top of its first node, bottom and top of its second.
  const corners = fins.map(([i, j], f) => f < finCount
    ? [xyz(i, 0), xyz(i, 1), xyz(j, 0), xyz(j, 1)]
    : [0, 3, 1, 2].map((k) => plates[f - finCount].slice(2 + 3 * k, 5 + 3 * k)));
  const low = [0, 1, 2].map((k) => nodes.reduce((least, n) => Math.min(least, n[k], n[k + 3]), Infinity));
  const high = [0, 1, 2].map((k) => nodes.reduce((most, n) => Math.max(most, n[k], n[k + 3]), -Infinity));
  const middle = low.map((x, k) => (x + high[k]) / 2);
  const radius = Math.hypot(...minus(high, low)) / 2 || 1;

  const FILL = [0, 2, 3, 0, 3, 1], EDGE = [0, 2, 2, 3, 3, 1, 1, 0];
  // A plate goes with the middle of its node's axis, taken from any fin there.
  const at_node = new Map(scene.fins.flatMap(([i, j], f) => [[i, [f, 0]], [j, [f, 6]]]));
  function motion(f) {
    if (f < finCount) return scene.motion[f];
    const [fin, from] = at_node.get(fins[f][0]) || [0, 0], m = scene.motion[fin];
    const middle = [0, 1, 2].map((k) => (m[from + k] + m[from + 3 + k]) / 2);
    return [...middle, ...middle, ...middle, ...middle];
  }
  function buffers(order) {
    const data = [];
    fins.forEach((fin, f) => {
      const c = corners[f], normal = unit(cross(minus(c[2], c[0]), minus(c[1], c[0])));
      for (const k of order) {
        const moved = scene.motion ? motion(f).slice(3 * k, 3 * k + 3) : [0, 0, 0];
        const axis = unit(minus(xyz(fin[k >> 1], 1), xyz(fin[k >> 1], 0)));
        data.push(...minus(c[k], middle).map((x) => x / radius), ...moved, ...axis, ...normal, fin[2]);
      }
    });
    const buffer = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(data), gl.STATIC_DRAW);
    return { buffer, colours: gl.createBuffer(), count: data.length / 13, order };
  }

  const shader = (type, text) => {
    const made = gl.createShader(type);
    gl.shaderSource(made, text);
    gl.compileShader(made);
    if (!gl.getShaderParameter(made, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(made));
    return made;
  };
  const program = gl.createProgram();
  gl.attachShader(program, shader(gl.VERTEX_SHADER, `
    attribute vec3 p, m, a, n, c; attribute float part;
    uniform mat3 view; uniform vec2 frame, pan;
    uniform float sway, lift, last, chosen, edge;
    varying vec3 shown;
    void main() {
      float isNew = abs(part - last) < 0.5 ? 1.0 : 0.0;
      vec3 q = view * (p + m * sway + a * (lift * isNew));
      gl_Position = vec4((q.xy + pan) * frame, -q.z * 0.3 - edge * 0.0008, 1.0);
      if (part > last + 0.5) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
      float light = 0.76 + 0.24 * abs(dot(view * n, normalize(vec3(0.3, 0.5, 0.8))));
      vec3 base = edge > 0.5 ? vec3(0.16, 0.19, 0.22) : c * light;
      if (edge < 0.5 && abs(part - chosen) < 0.5) base = vec3(1.0, 0.48, 0.0) * light;
      shown = base;
    }`));
  gl.attachShader(program, shader(gl.FRAGMENT_SHADER, `
    precision mediump float; varying vec3 shown;
    void main() { gl_FragColor = vec4(shown, 1.0); }`));
  gl.linkProgram(program);
  gl.useProgram(program);
  const uniform = (name) => gl.getUniformLocation(program, name);
  const at = Object.fromEntries(["view", "frame", "pan", "sway", "lift", "last", "chosen", "edge"].map((n) => [n, uniform(n)]));
  const filled = buffers(FILL), edged = buffers(EDGE);

  // ---- colours: by part, or from pale over yellow to red
  const RAMP = __HEAT__;
  const heat = (x) => {
    const t = Math.max(0, Math.min(1, x)) * 2, k = Math.min(1, Math.floor(t)), s = t - k;
    return [0, 1, 2].map((c) => RAMP[k][c] * (1 - s) + RAMP[k + 1][c] * s);
  };
  const hue = (part) => {
    const h = (part * 0.618034) % 1;
    return [0, 1 / 3, 2 / 3].map((o) => 0.62 + 0.3 * Math.cos(2 * Math.PI * (h - o)));
  };
  const digits = (x) => (x === 0 ? "0" : Number(x.toPrecision(3)).toString());
  const MEANINGS = {
    planarity: () => ({ at: (fin) => fin[3], most: scene.planarity_limit, low: "flat", high: `${digits(scene.planarity_limit)} %`, words: "How far the corners of a fin are off one plane, as a share of its size; red is the limit." }),
    discrepancy: () => {
      const most = fins.reduce((most, fin) => Math.max(most, fin[4] || 0, fin[5] || 0), 1e-12);
      return { at: (fin, end) => (fin[4 + end] || 0), most, low: "0", high: digits(most), words: "How far parts would have to leave each other at a node in the softest motion, the far node moving by 1." };
    },
    bend: () => ({ at: (fin, end) => fin[6 + end], most: 1 / scene.bend_model, low: "straight", high: `radius ${digits(scene.bend_model)} × thickness`, words: "How tightly the sheet bends at a node; red is the limit for a model." }),
  };
  function paint() {
    const kind = by("colour").value, meaning = MEANINGS[kind] && MEANINGS[kind]();
    const legend = by("legend");
    legend.hidden = !meaning;
    if (meaning) { by("low").textContent = meaning.low; by("high").textContent = meaning.high; by("meaning").textContent = meaning.words; }
    const colour = (fin, k) => (meaning ? heat(meaning.at(fin, k >> 1) / meaning.most) : fin[2] < 0 ? [0.8, 0.84, 0.87] : hue(fin[2]));
    for (const set of [filled, edged]) {
      const data = fins.flatMap((fin) => set.order.flatMap((k) => colour(fin, k)));
      gl.bindBuffer(gl.ARRAY_BUFFER, set.colours);
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(data), gl.STATIC_DRAW);
    }
    draw();
  }

  // ---- drawing
  function view() {
    const [ct, st, cp, sp] = [Math.cos(state.turn), Math.sin(state.turn), Math.cos(state.tilt), Math.sin(state.tilt)];
    const right = [-st, ct, 0], toward = [ct * cp, st * cp, sp];
    return [right, cross(toward, right), toward];
  }
  let asked = false;
  function draw() {
    if (!asked && gl) { asked = true; requestAnimationFrame(render); }
  }
  /** How far a unit across and up the view reaches, as shares of half the canvas. */
  function frame() {
    const wide = canvas.clientWidth / Math.max(1, canvas.clientHeight), zoom = state.zoom * 1.05;
    return wide > 1 ? [zoom / wide, zoom] : [zoom, zoom * wide];
  }
  function render(time) {
    asked = false;
    const ratio = devicePixelRatio || 1;
    const size = [Math.round(canvas.clientWidth * ratio), Math.round(canvas.clientHeight * ratio)];
    if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(1, 1, 1, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    if (state.playing) state.sway = 0.09 * Math.sin(time / 500);
    if (state.lift > 0) state.lift = Math.max(0, state.lift - 0.012);
    const rows = view();
    gl.uniformMatrix3fv(at.view, false, [0, 1, 2].flatMap((c) => rows.map((row) => row[c])));
    gl.uniform2f(at.frame, ...frame());
    gl.uniform2f(at.pan, ...state.pan);
    gl.uniform1f(at.sway, state.sway);
    gl.uniform1f(at.lift, state.lift);
    gl.uniform1f(at.last, parts.length ? state.step - 1 : 0);
    // Fins without a part have -1.
    gl.uniform1f(at.chosen, state.part < 0 ? -2 : state.part);
    for (const [set, kind, edge] of [[filled, gl.TRIANGLES, 0], [edged, gl.LINES, 1]]) {
      gl.uniform1f(at.edge, edge);
      gl.bindBuffer(gl.ARRAY_BUFFER, set.buffer);
      ["p", "m", "a", "n"].forEach((name, k) => attribute(name, 3, 52, 12 * k));
      attribute("part", 1, 52, 48);
      gl.bindBuffer(gl.ARRAY_BUFFER, set.colours);
      attribute("c", 3, 12, 0);
      gl.drawArrays(kind, 0, set.count);
    }
    if (state.playing || state.lift > 0) draw();
  }
  function attribute(name, size, stride, offset) {
    const place = gl.getAttribLocation(program, name);
    if (place < 0) return;
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, size, gl.FLOAT, false, stride, offset);
  }

  // ---- picking: the nearest fin under a point of the canvas
  function project(point) {
    const q = minus(point, middle).map((x) => x / radius), [right, up, toward] = view();
    const [fx, fy] = frame();
    return [((dot(q, right) + state.pan[0]) * fx + 1) / 2 * canvas.clientWidth, (1 - (dot(q, up) + state.pan[1]) * fy) / 2 * canvas.clientHeight, dot(q, toward)];
  }
  function pick(x, y) {
    let best = -1, near = -Infinity;
    const side = (a, b) => (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
    fins.forEach((fin, f) => {
      if (parts.length && fin[2] >= state.step) return;
      const c = corners[f].map(project);
      for (let t = 0; t < 6; t += 3) {
        const [a, b, d] = [c[FILL[t]], c[FILL[t + 1]], c[FILL[t + 2]]];
        const [u, v, w] = [side(b, d), side(d, a), side(a, b)], sum = u + v + w;
        if (Math.abs(sum) < 1e-9 || u * sum < 0 || v * sum < 0 || w * sum < 0) continue;
        const depth = (u * a[2] + v * b[2] + w * d[2]) / sum;
        if (depth > near) [near, best] = [depth, fin[2]];
      }
    });
    return best;
  }

  // ---- hands
  let drag = null;
  canvas.addEventListener("pointerdown", (e) => { canvas.setPointerCapture(e.pointerId); drag = { x: e.clientX, y: e.clientY, far: 0, pan: e.button === 2 || e.shiftKey }; });
  canvas.addEventListener("pointermove", (e) => {
    if (!drag) { canvas.style.cursor = pick(e.offsetX, e.offsetY) < 0 ? "grab" : "pointer"; return; }
    const [dx, dy] = [e.clientX - drag.x, e.clientY - drag.y];
    [drag.x, drag.y, drag.far] = [e.clientX, e.clientY, drag.far + Math.abs(dx) + Math.abs(dy)];
    if (drag.pan) move(dx, dy); else turn(-dx * 0.008, dy * 0.008);
  });
  canvas.addEventListener("pointerup", (e) => { if (drag && drag.far < 4) choose(pick(e.offsetX, e.offsetY)); drag = null; });
  canvas.addEventListener("contextmenu", (e) => e.preventDefault());
  canvas.addEventListener("wheel", (e) => { e.preventDefault(); zoom(Math.exp(-e.deltaY * 0.001)); }, { passive: false });
  const turn = (a, b) => { state.turn += a; state.tilt = Math.max(-1.57, Math.min(1.57, state.tilt + b)); draw(); };
  const zoom = (by) => { state.zoom = Math.max(0.3, Math.min(40, state.zoom * by)); draw(); };
  const move = (dx, dy) => { const s = 2 / (state.zoom * Math.min(canvas.clientWidth, canvas.clientHeight)); state.pan = [state.pan[0] + dx * s, state.pan[1] - dy * s]; draw(); };
  const KEYS = { ArrowLeft: () => turn(0.1, 0), ArrowRight: () => turn(-0.1, 0), ArrowUp: () => turn(0, 0.1), ArrowDown: () => turn(0, -0.1), "+": () => zoom(1.15), "=": () => zoom(1.15), "-": () => zoom(1 / 1.15), Home: () => home() };
  canvas.addEventListener("keydown", (e) => { if (KEYS[e.key]) { e.preventDefault(); KEYS[e.key](); } });
  /** The view from above the side, the whole structure in the middle and as large as fits. */
  function home() {
    Object.assign(state, { turn: __AROUND__, tilt: __UP__, zoom: 1, pan: [0, 0] });
    const rows = view(), [fx, fy] = frame();
    const flat = corners.flat().map((p) => minus(p, middle).map((x) => x / radius)).map((q) => [dot(q, rows[0]), dot(q, rows[1])]);
    const ends = [0, 1].map((k) => flat.reduce(([a, b], q) => [Math.min(a, q[k]), Math.max(b, q[k])], [Infinity, -Infinity]));
    if (flat.length) {
      state.pan = ends.map(([a, b]) => -(a + b) / 2);
      state.zoom = Math.min(...ends.map(([a, b], k) => 1.8 / ((b - a) * [fx, fy][k])), 40);
    }
    draw();
  }

  const slider = by("step");
  const count = Math.max(1, parts.length);
  Object.assign(slider, { max: count, value: count, disabled: !parts.length });
  function build() {
    state.step = Number(slider.value);
    by("stepword").textContent = parts.length ? `${state.step} of ${count}: ${parts[state.step - 1].id}` : "no parts";
    state.lift = state.step < count ? 0.25 : 0;
    draw();
  }
  slider.addEventListener("input", () => { build(); choose(state.step - 1); });
  const button = by("motion");
  button.disabled = !scene.motion;
  button.addEventListener("click", () => {
    state.playing = !state.playing;
    if (!state.playing) state.sway = 0;
    button.setAttribute("aria-pressed", state.playing);
    button.textContent = state.playing ? "Stop the motion" : "Play the softest motion";
    draw();
  });
  const go = (by) => parts.length && choose((Math.max(state.part, by < 0 ? 0 : -1) + by + parts.length) % parts.length);
  by("next").addEventListener("click", () => go(1));
  by("previous").addEventListener("click", () => go(-1));
  by("home").addEventListener("click", home);
  by("colour").addEventListener("change", paint);
  addEventListener("resize", draw);
  Object.assign(window.finwright, { project, pick, corners, colour: (kind) => { by("colour").value = kind; paint(); } });
  if (!parts.length) by("colour").value = scene.motion ? "discrepancy" : "planarity";
  home();
  build();
  paint();
})();
