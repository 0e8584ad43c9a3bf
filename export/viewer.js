"use strict";
// A small WebGL view of the deformed segment. Data: see export/viewer_data.py.
(function () {
  const data = JSON.parse(document.getElementById("view-data").textContent);
  const box = document.getElementById("view3d");
  const canvas = box.querySelector("canvas");
  const gl = canvas.getContext("webgl", { antialias: true, preserveDrawingBuffer: true });
  if (!gl || !gl.getExtension("OES_standard_derivatives") || !gl.getExtension("OES_element_index_uint")) {
    box.querySelector(".message").textContent =
      "This browser cannot draw in 3D (no WebGL); the pictures above show the same.";
    return;
  }

  const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const floats = (text) => new Float32Array(bytes(text).buffer);
  const points = floats(data.points);
  const displacement = new Int16Array(bytes(data.displacement).buffer);
  const region = bytes(data.region);
  const stress = bytes(data.stress);
  const strain = bytes(data.strain);
  const colourMap = bytes(data.colourMap);
  const count = points.length / 3;
  const film = data.names.indexOf("film");
  const state = { step: data.steps.length - 1, mode: "part", cut: !data.slice, yaw: 0.5, tilt: 0.3, zoom: 1 };

  // Flat normals come from screen derivatives: no normals need to be stored for each step.
  const vertexCode = `
    attribute vec3 place; attribute vec3 rest; attribute vec3 colour; attribute float part;
    uniform mat3 turn; uniform vec3 centre; uniform vec3 shift; uniform vec2 scale;
    varying vec3 seen; varying vec3 paint; varying float restY; varying float partOf;
    void main() {
      seen = turn * (place + shift - centre);
      paint = colour; restY = rest.y; partOf = part;
      gl_Position = vec4(seen.xy * scale, -seen.z * 0.02, 1.0);
    }`;
  const fragmentCode = `
    #extension GL_OES_standard_derivatives : enable
    precision highp float;
    uniform float plane; uniform float topPart;
    varying vec3 seen; varying vec3 paint; varying float restY; varying float partOf;
    void main() {
      if (restY < plane || partOf > topPart + 0.5) discard;
      vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
      float light = 0.55 + 0.45 * abs(dot(normal, normalize(vec3(-0.35, 0.5, 0.8))));
      gl_FragColor = vec4(paint * light, 1.0);
    }`;

  function compile(kind, code) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, code);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    return shader;
  }

  const program = gl.createProgram();
  gl.attachShader(program, compile(gl.VERTEX_SHADER, vertexCode));
  gl.attachShader(program, compile(gl.FRAGMENT_SHADER, fragmentCode));
  gl.linkProgram(program);
  gl.useProgram(program);
  const uniform = (name) => gl.getUniformLocation(program, name);
  const uniforms = {};
  ["turn", "centre", "shift", "scale", "plane", "topPart"].forEach((n) => (uniforms[n] = uniform(n)));

  function buffer(target, content) {
    const made = gl.createBuffer();
    gl.bindBuffer(target, made);
    gl.bufferData(target, content, gl.STATIC_DRAW);
    return made;
  }

  function refill(made, content) {
    gl.bindBuffer(gl.ARRAY_BUFFER, made);
    gl.bufferData(gl.ARRAY_BUFFER, content, gl.DYNAMIC_DRAW);
  }

  function attach(name, made, size) {
    const location = gl.getAttribLocation(program, name);
    if (location < 0) return;
    gl.bindBuffer(gl.ARRAY_BUFFER, made);
    gl.enableVertexAttribArray(location);
    gl.vertexAttribPointer(location, size, gl.FLOAT, false, 0, 0);
  }

  function body(rest, parts, lists) {
    const made = { rest: buffer(gl.ARRAY_BUFFER, rest), place: buffer(gl.ARRAY_BUFFER, rest) };
    made.colour = buffer(gl.ARRAY_BUFFER, new Float32Array(rest.length));
    made.part = buffer(gl.ARRAY_BUFFER, parts);
    made.lists = {};
    for (const [name, indices] of Object.entries(lists)) {
      made.lists[name] = { made: buffer(gl.ELEMENT_ARRAY_BUFFER, indices), count: indices.length };
    }
    return made;
  }

  const integers = (text) => new Uint32Array(bytes(text).buffer);
  const segment = body(points, Float32Array.from(region), {
    outer: integers(data.outer), section: integers(data.section), film: integers(data.film),
  });

  function dotBody(corners) {
    const made = body(corners, new Float32Array(corners.length / 3), {
      all: Uint32Array.from({ length: corners.length / 3 }, (_, i) => i),
    });
    refill(made.colour, corners.map((_, i) => data.dotColour[i % 3]));
    return made;
  }

  const dotPoints = floats(data.dotPoints);
  const dot = dotBody(dotPoints);
  const dotCut = dotBody(floats(data.dotCut));

  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  [points, dotPoints].forEach((array) => array.forEach((value, i) => {
    low[i % 3] = Math.min(low[i % 3], value);
    high[i % 3] = Math.max(high[i % 3], value);
  }));
  const centre = low.map((value, i) => (value + high[i]) / 2);
  const size = Math.hypot(...low.map((value, i) => high[i] - value));

  // Which value colours a corner: null leaves it in the colour of its part.
  function shade(i) {
    if (state.mode === "stress" && region[i] !== film) return stress[state.step * count + i];
    if (state.mode === "strain" && region[i] === film) return strain[state.step * count + i];
    return null;
  }

  function fill() {
    const place = new Float32Array(points.length);
    const colour = new Float32Array(points.length);
    const from = state.step * points.length;
    for (let i = 0; i < place.length; i++) place[i] = points[i] + data.displacementUnit * displacement[from + i];
    for (let i = 0; i < count; i++) {
      const value = shade(i);
      for (let k = 0; k < 3; k++) {
        colour[3 * i + k] = value === null ? data.colours[region[i]][k] : colourMap[3 * value + k] / 255;
      }
    }
    refill(segment.place, place);
    refill(segment.colour, colour);
    draw();
  }

  // Rows: right, up, towards the viewer.
  function turning() {
    const [sy, cy, st, ct] = [Math.sin(state.yaw), Math.cos(state.yaw), Math.sin(state.tilt), Math.cos(state.tilt)];
    const rows = [[cy, sy, 0], [-sy * st, cy * st, ct], [sy * ct, -cy * ct, st]];
    return new Float32Array([0, 1, 2].flatMap((column) => rows.map((row) => row[column])));
  }

  function drawList(made, name) {
    const list = made.lists[name];
    [["place", 3], ["rest", 3], ["colour", 3], ["part", 1]].forEach(([n, width]) => attach(n, made[n], width));
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, list.made);
    gl.drawElements(gl.TRIANGLES, list.count, gl.UNSIGNED_INT, 0);
  }

  function draw() {
    const ratio = window.devicePixelRatio || 1;
    const width = Math.round(canvas.clientWidth * ratio), height = Math.round(canvas.clientHeight * ratio);
    if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
    const scale = (2 * 0.95 * state.zoom) / size;
    gl.viewport(0, 0, width, height);
    gl.clearColor(1, 1, 1, 1);
    gl.enable(gl.DEPTH_TEST);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniformMatrix3fv(uniforms.turn, false, turning());
    gl.uniform3fv(uniforms.centre, centre);
    gl.uniform2f(uniforms.scale, (scale * height) / width, scale);
    const cut = state.cut ? data.plane : -1e9;
    gl.uniform1f(uniforms.plane, cut);
    gl.uniform1f(uniforms.topPart, state.mode === "strain" ? film : data.names.length);
    gl.uniform3f(uniforms.shift, 0, 0, 0);
    drawList(segment, "outer");
    if (state.mode === "strain") drawList(segment, "film");
    if (state.cut) {
      gl.uniform1f(uniforms.plane, -1e9);
      drawList(segment, "section");
    }
    if (state.mode !== "strain") {
      gl.uniform1f(uniforms.plane, -1e9);
      gl.uniform3fv(uniforms.shift, data.dotShift[state.step]);
      drawList(state.cut ? dotCut : dot, "all");
    }
  }

  function describe() {
    const step = data.steps[state.step];
    box.querySelector(".step-text").textContent =
      step.indentation.toFixed(3) + " mm, " + step.force.toPrecision(3) + " N";
    const legend = box.querySelector(".legend");
    const top = { stress: data.stressTop.toPrecision(2) + " MPa", strain: (100 * data.strainTop).toPrecision(2) + " %" };
    legend.style.visibility = state.mode === "part" ? "hidden" : "visible";
    legend.querySelector(".top").textContent = top[state.mode] || "";
    const stops = [0, 51, 102, 153, 204, 255].map((i) => "rgb(" + colourMap.slice(3 * i, 3 * i + 3).join(",") + ")");
    legend.querySelector(".bar").style.background = "linear-gradient(to right," + stops.join(",") + ")";
  }

  function update() { describe(); fill(); }

  const slider = box.querySelector("input[type=range]");
  slider.max = String(data.steps.length - 1);
  slider.value = String(state.step);
  slider.addEventListener("input", () => { state.step = Number(slider.value); update(); });
  box.querySelector("select").addEventListener("change", (event) => { state.mode = event.target.value; update(); });
  const cutBox = box.querySelector("input[type=checkbox]");
  cutBox.checked = state.cut;
  cutBox.addEventListener("change", () => { state.cut = cutBox.checked; draw(); });

  let held = null;
  canvas.addEventListener("pointerdown", (event) => { held = [event.clientX, event.clientY]; canvas.setPointerCapture(event.pointerId); });
  canvas.addEventListener("pointerup", () => { held = null; });
  canvas.addEventListener("pointermove", (event) => {
    if (!held) return;
    state.yaw -= (event.clientX - held[0]) * 0.008;
    state.tilt = Math.max(-1.57, Math.min(1.57, state.tilt + (event.clientY - held[1]) * 0.008));
    held = [event.clientX, event.clientY];
    draw();
  });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    state.zoom = Math.max(0.3, Math.min(12, state.zoom * Math.exp(-event.deltaY * 0.001)));
    draw();
  }, { passive: false });
  window.addEventListener("resize", draw);
  update();
})();
