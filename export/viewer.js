"use strict";
// A small WebGL view of the parts and of the deformed segment. Data: see export/viewer_data.py.
// softdotViewer(box) draws into the canvas of a box and listens to the controls in it; show(data) exchanges the body.
function softdotViewer(box) {
  const canvas = box.querySelector("canvas");
  const painter = softdotPainter(canvas);
  if (!painter) {
    box.querySelector(".message").textContent = "This browser cannot draw in 3D (no WebGL).";
    return { show() {} };
  }

  const bytes = (found) => (typeof found === "string" ? Uint8Array.from(atob(found), (c) => c.charCodeAt(0)) : found);
  const floats = (text) => new Float32Array(bytes(text).buffer);
  const integers = (text) => new Uint32Array(bytes(text).buffer);
  const state = { step: 0, mode: "part", cut: true, yaw: 0.5, tilt: 0.3, zoom: 1.2 };
  let data = null, body = null;

  // What is shown: what was chosen, where the data have it.
  const mode = () => (data[state.mode] ? state.mode : "part");
  // What can be shown: its unit, on which parts, in which colours; what lies above the film is hidden for the film.
  const onFilm = (part) => part === body.film;
  const modes = {
    part: null,
    stress: { unit: "MPa", factor: 1, on: (part) => part !== body.film },
    strain: { unit: "%", factor: 100, on: onFilm, bare: true },
    charge: { unit: "pC/mm²", factor: 1, on: onFilm, bare: true, map: "diverging" },
    pressure: { unit: "MPa", factor: 1, on: (part) => part === data.names.length - 1 },
  };

  function dotBody(corners) {
    const made = painter.load(corners, new Float32Array(corners.length / 3), {
      all: Uint32Array.from({ length: corners.length / 3 }, (_, i) => i),
    });
    painter.refill(made.colour, corners.map((_, i) => data.dotColour[i % 3]));
    return made;
  }

  function load() {
    const points = floats(data.points), dotPoints = floats(data.dotPoints), region = bytes(data.region);
    const lists = { outer: integers(data.outer), section: integers(data.section), film: integers(data.film) };
    if (body) [body.segment, body.dot, body.dotCut].forEach(painter.forget);
    body = { points, region, count: points.length / 3, film: data.names.indexOf("film"), values: {} };
    body.displacement = new Int16Array(bytes(data.displacement).buffer);
    for (const name of Object.keys(modes)) if (data[name]) body.values[name] = bytes(data[name]);
    body.maps = { colourMap: bytes(data.colourMap), diverging: bytes(data.diverging) };
    body.segment = painter.load(points, Float32Array.from(region), lists);
    body.dot = dotBody(dotPoints);
    body.dotCut = dotBody(floats(data.dotCut));
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    [points, dotPoints].forEach((array) => array.forEach((value, i) => {
      low[i % 3] = Math.min(low[i % 3], value);
      high[i % 3] = Math.max(high[i % 3], value);
    }));
    body.centre = low.map((value, i) => (value + high[i]) / 2);
    body.size = Math.hypot(...low.map((value, i) => high[i] - value));
  }

  function fill() {
    const { points, region, count } = body, shown = modes[mode()];
    const values = body.values[mode()], map = body.maps[(shown && shown.map) || "colourMap"];
    const place = new Float32Array(points.length), colour = new Float32Array(points.length);
    const from = state.step * points.length;
    for (let i = 0; i < place.length; i++) {
      place[i] = points[i] + data.displacementUnit * body.displacement[from + i];
    }
    for (let i = 0; i < count; i++) {
      const value = values && shown.on(region[i]) ? values[state.step * count + i] : null;
      for (let k = 0; k < 3; k++) {
        colour[3 * i + k] = value === null ? data.colours[region[i]][k] : map[3 * value + k] / 255;
      }
    }
    painter.refill(body.segment.place, place);
    painter.refill(body.segment.colour, colour);
    draw();
  }

  // Rows: right, up, towards the viewer.
  function turning() {
    const [sy, cy, st, ct] = [Math.sin(state.yaw), Math.cos(state.yaw), Math.sin(state.tilt), Math.cos(state.tilt)];
    const rows = [[cy, sy, 0], [-sy * st, cy * st, ct], [sy * ct, -cy * ct, st]];
    return new Float32Array([0, 1, 2].flatMap((column) => rows.map((row) => row[column])));
  }

  function draw() {
    if (!body) return;
    const ratio = window.devicePixelRatio || 1;
    const width = Math.round(canvas.clientWidth * ratio), height = Math.round(canvas.clientHeight * ratio);
    if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
    const scale = (2 * 0.95 * state.zoom) / body.size, shown = modes[mode()], cut = state.cut && !data.slice;
    const fitted = scale * Math.min(1, width / height);
    painter.clear(width, height, background());
    painter.set("turn", turning());
    painter.set("centre", ...body.centre);
    painter.set("scale", (fitted * height) / width, fitted);
    painter.set("plane", cut ? data.plane : -1e9);
    painter.set("topPart", shown && shown.bare ? body.film : data.names.length);
    painter.set("shift", 0, 0, 0);
    painter.draw(body.segment, "outer");
    if (shown && shown.bare) painter.draw(body.segment, "film");
    painter.set("plane", -1e9);
    if (cut) painter.draw(body.segment, "section");
    if (!shown || mode() === "stress") {
      painter.set("shift", ...data.dotShift[state.step]);
      painter.draw(cut ? body.dotCut : body.dot, "all");
    }
  }

  // The colour that the page gives the canvas; white where it gives none.
  function background() {
    const [r, g, b, a] = getComputedStyle(canvas).backgroundColor.match(/[\d.]+/g).map(Number);
    return a === 0 ? [1, 1, 1] : [r / 255, g / 255, b / 255];
  }

  const find = (selector) => box.querySelector(selector);
  const slider = find("input[type=range]"), select = find("select"), cutBox = find("input[type=checkbox]");
  const play = find("button.play");

  function describe() {
    const step = data.steps[state.step], legend = find(".legend"), shown = modes[mode()];
    find(".step-text").textContent = step.indentation.toFixed(3) + " mm, " + step.force.toPrecision(3) + " N";
    legend.style.visibility = shown ? "visible" : "hidden";
    if (!shown) return;
    const top = String(Number((shown.factor * data[mode() + "Top"]).toPrecision(2))), map = body.maps[shown.map || "colourMap"];
    legend.querySelector(".low").textContent = shown.map ? "−" + top : "0";
    legend.querySelector(".top").textContent = top + " " + shown.unit;
    const stops = [0, 51, 102, 153, 204, 255].map((i) => "rgb(" + map.slice(3 * i, 3 * i + 3).join(",") + ")");
    legend.querySelector(".bar").style.background = "linear-gradient(to right," + stops.join(",") + ")";
  }

  function update() { describe(); fill(); }

  function go(step) {
    state.step = step;
    slider.value = String(step);
    update();
  }

  let ticking = null;
  function stop() {
    window.clearInterval(ticking);
    ticking = null;
    play.textContent = "Play";
  }

  function show(given) {
    data = given;
    load();
    slider.max = String(data.steps.length - 1);
    go(data.steps.length - 1);
  }

  slider.addEventListener("input", () => data && go(Number(slider.value)));
  select.addEventListener("change", () => { state.mode = select.value; if (data) update(); });
  cutBox.checked = state.cut;
  cutBox.addEventListener("change", () => { state.cut = cutBox.checked; draw(); });
  play.addEventListener("click", () => {
    if (ticking) return stop();
    play.textContent = "Stop";
    ticking = window.setInterval(() => data && go((state.step + 1) % data.steps.length), 400);
  });

  function turn(yaw, tilt) {
    state.yaw += yaw;
    state.tilt = Math.max(-1.57, Math.min(1.57, state.tilt + tilt));
    draw();
  }
  function zoom(factor) { state.zoom = Math.max(0.3, Math.min(12, state.zoom * factor)); draw(); }
  const keys = {
    ArrowLeft: () => turn(0.1, 0), ArrowRight: () => turn(-0.1, 0), ArrowUp: () => turn(0, 0.1),
    ArrowDown: () => turn(0, -0.1), "+": () => zoom(1.2), "-": () => zoom(1 / 1.2),
  };
  canvas.addEventListener("keydown", (event) => {
    if (!keys[event.key]) return;
    keys[event.key]();
    event.preventDefault();
  });
  let held = null;
  canvas.addEventListener("pointerdown", (event) => {
    held = [event.clientX, event.clientY];
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointerup", () => { held = null; });
  canvas.addEventListener("pointermove", (event) => {
    if (!held) return;
    turn((held[0] - event.clientX) * 0.008, (event.clientY - held[1]) * 0.008);
    held = [event.clientX, event.clientY];
  });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoom(Math.exp(-event.deltaY * 0.001));
  }, { passive: false });
  window.addEventListener("resize", draw);
  return { show, draw };
}
