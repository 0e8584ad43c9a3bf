"use strict";
// Triangles on a canvas by WebGL, for export/viewer.js; null where a browser has none.
function softdotPainter(canvas) {
  const gl = canvas.getContext("webgl", { antialias: true, preserveDrawingBuffer: true });
  if (!gl || !gl.getExtension("OES_standard_derivatives") || !gl.getExtension("OES_element_index_uint")) return null;

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

  function load(rest, parts, lists) {
    const made = { rest: buffer(gl.ARRAY_BUFFER, rest), place: buffer(gl.ARRAY_BUFFER, rest) };
    made.colour = buffer(gl.ARRAY_BUFFER, new Float32Array(rest.length));
    made.part = buffer(gl.ARRAY_BUFFER, parts);
    made.lists = {};
    for (const [name, indices] of Object.entries(lists)) {
      made.lists[name] = { made: buffer(gl.ELEMENT_ARRAY_BUFFER, indices), count: indices.length };
    }
    return made;
  }

  function forget(made) {
    [made.rest, made.place, made.colour, made.part].forEach((one) => gl.deleteBuffer(one));
    Object.values(made.lists).forEach((list) => gl.deleteBuffer(list.made));
  }

  function clear(width, height, background) {
    gl.viewport(0, 0, width, height);
    gl.clearColor(...background, 1);
    gl.enable(gl.DEPTH_TEST);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  }

  function set(name, ...values) {
    if (name === "turn") gl.uniformMatrix3fv(uniforms.turn, false, values[0]);
    else gl["uniform" + values.length + "f"](uniforms[name], ...values);
  }

  function draw(made, name) {
    const list = made.lists[name];
    [["place", 3], ["rest", 3], ["colour", 3], ["part", 1]].forEach(([n, width]) => attach(n, made[n], width));
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, list.made);
    gl.drawElements(gl.TRIANGLES, list.count, gl.UNSIGNED_INT, 0);
  }

  return { load, forget, refill, clear, set, draw };
}
