// The 3D view: camera, mouse, keys and the controls beside it.
import * as THREE from "./three.module.min.js";
import { Bodies } from "./bodies.js";
import { Camera, VIEWS } from "./camera.js";
import { element, roving } from "./dom.js";
import { colourBar, drawMarks, legend } from "./marks.js";

// Room beside the body for what is written there, in px.
const ROOM = { left: 12, right: 136, top: 34, bottom: 52 },
  NARROW = { below: 480, left: 2, right: 46 }, // a canvas where the buttons of the views stand in a row above the body
  ROOM_OF_BAR = 34;
const TICK_MS = 400,
  REST_MS = 60,
  SMOOTH_MS = 400,
  FINER = 2;
const spoken = (value) => String(Number(value.toPrecision(3)));

// Whether the processor draws, for which several samples of each pixel are half of all work: there edges are smoothed by
// a finer picture once the view rests.
function isDrawnByProcessor() {
  const gl = document.createElement("canvas").getContext("webgl2"),
    about = gl && gl.getExtension("WEBGL_debug_renderer_info");
  const name = about ? gl.getParameter(about.UNMASKED_RENDERER_WEBGL) : "";
  return /swiftshader|llvmpipe|softpipe|basic render/i.test(name);
}

export class View {
  // box: the element that holds the canvas and its controls.
  constructor(box) {
    this.box = box;
    this.find = (selector) => box.querySelector(selector);
    this.canvas = this.find("canvas");
    this.bodies = new Bodies();
    this.sized = true;
    this.isSlow = isDrawnByProcessor();
    try {
      this.renderer = new THREE.WebGLRenderer({
        canvas: this.canvas,
        antialias: !this.isSlow,
        alpha: true,
        stencil: true,
      });
    } catch {
      this.find(".shown").textContent = "This browser cannot draw in 3D (no WebGL).";
      return;
    }
    this.camera = new Camera(this.canvas, () => this.draw());
    this.camera.controls.addEventListener("start", () => this.find(".hover").replaceChildren());
    this.listen();
    this.wake(false);
    new ResizeObserver(() => (this.camera.isFitted ? this.fit() : this.draw())).observe(this.canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
  }

  // data: of export/solid_view.py.
  show(data) {
    this.data = data;
    if (!this.renderer) return;
    const { bodies } = this;
    bodies.load(data);
    bodies.settle(bodies.isMoved ? bodies.section.at : this.middle());
    const parts = [...data.names.map((name, i) => [name, data.colours[i]]), ["dot", data.dotColour]];
    legend(this.find(".legend"), parts.reverse(), bodies.hidden, (name) => this.toggle(name));
    const slider = this.find(".step");
    slider.max = String(data.steps.length - 1);
    this.find(".play").disabled = data.steps.length < 2;
    this.find(".section").disabled = data.slice;
    this.go(data.steps.length - 1);
    if (this.camera.isFitted) this.fit();
  }

  toggle(name) {
    this.bodies.hidden[name] = !this.bodies.hidden[name];
    this.bodies.cut();
    this.draw();
    return this.bodies.hidden[name];
  }

  go(step) {
    const { bodies, data } = this,
      { indentation, force } = data.steps[step];
    bodies.step = step;
    bodies.update();
    this.find(".step").value = String(step);
    this.find(".step-text").textContent = `${indentation.toFixed(3)} mm, ${force.toPrecision(3)} N`;
    const { shown } = bodies;
    colourBar(
      this.find(".bar"),
      shown,
      shown && shown.factor * data.tops[bodies.field],
      shown && data[shown.map || "colourMap"],
    );
    this.draw();
  }

  // Where a section begins: under the dot, or in the middle where the dot is beside the body.
  middle() {
    const { low, high, section } = this.bodies,
      axis = section.axis === "x" ? 0 : 1;
    const under = axis === 1 && this.data.plane > low[1] && this.data.plane < high[1];
    return under ? this.data.plane : (low[axis] + high[axis]) / 2;
  }

  place(at) {
    this.bodies.settle(at);
    this.bodies.cut();
    this.draw();
  }

  // All corners of what is shown, the dot above it included.
  corners() {
    const { low, high } = this.bodies,
      dot = this.data.dotPoints,
      ends = [[...low], [...high]];
    for (let i = 0; i < dot.length; i++) {
      ends[0][i % 3] = Math.min(ends[0][i % 3], dot[i]);
      ends[1][i % 3] = Math.max(ends[1][i % 3], dot[i]);
    }
    return [0, 1, 2, 3, 4, 5, 6, 7].map(
      (n) => new THREE.Vector3(ends[n & 1][0], ends[(n >> 1) & 1][1], ends[n >> 2][2]),
    );
  }

  fit() {
    if (!this.data) return;
    const bottom = ROOM.bottom + (this.bodies.shown ? ROOM_OF_BAR : 0);
    const sides = this.canvas.clientWidth < NARROW.below ? NARROW : ROOM;
    this.camera.fit(this.corners(), { ...ROOM, left: sides.left, right: sides.right, bottom });
    this.draw();
  }

  draw() {
    if (this.waiting || !this.data) return;
    this.waiting = requestAnimationFrame(() => {
      this.waiting = null;
      this.render(1);
    });
    clearTimeout(this.smoothing);
    if (this.isSlow) this.smoothing = setTimeout(() => this.render(FINER), SMOOTH_MS);
  }

  // finer: pixels drawn for one that is shown, along each side.
  render(finer) {
    const { renderer, camera, canvas } = this,
      width = canvas.clientWidth,
      height = canvas.clientHeight;
    if (!width || !height || !camera.half) return;
    const size = [width, height, finer * (window.devicePixelRatio || 1)];
    if (String(size) !== String(this.size)) {
      renderer.setPixelRatio(size[2]);
      renderer.setSize(width, height, false); // makes new buffers, also where the size is the same
      this.size = size;
    }
    camera.frame(width, height);
    renderer.render(this.bodies.scene, camera.lens);
    this.project = camera.projection(width, height);
    const { low, high } = this.bodies,
      about = { low, high, width, height, withDimensions: this.sized };
    drawMarks(this.find("svg.marks"), {
      ...about,
      project: this.project,
      turn: camera.turning(),
      pixels: camera.scale(height),
    });
    this.handle();
  }

  // The handle of the section stands at the upper edge of the body.
  handle() {
    const { low, high, section } = this.bodies,
      handle = this.find(".handle"),
      on = Boolean(section.axis) && !this.data.slice;
    handle.hidden = !on;
    if (!on) return;
    const axis = section.axis === "x" ? 0 : 1,
      at = [high[0], low[1], high[2]];
    at[axis] = section.at;
    const [x, y] = this.project(at);
    handle.style.left = `${Math.min(Math.max(x + 4, 0), this.canvas.clientWidth - 30)}px`;
    handle.style.top = `${Math.min(Math.max(y - 30, 0), this.canvas.clientHeight - 30)}px`;
    handle.setAttribute("aria-valuenow", section.at.toFixed(3));
    handle.setAttribute("aria-valuemin", low[axis].toFixed(3));
    handle.setAttribute("aria-valuemax", high[axis].toFixed(3));
    handle.setAttribute("aria-valuetext", `${section.axis} = ${section.at.toFixed(2)} mm`);
  }

  // The wheel turns the page until the view has been clicked.
  wake(on) {
    this.awake = on;
    this.camera.controls.enableZoom = on;
    this.canvas.style.touchAction = on ? "none" : "pan-y";
    if (on) this.find(".wheel").hidden = true;
  }

  listen() {
    const { canvas, find } = this;
    this.buttons();
    this.dragged();
    canvas.addEventListener("pointerdown", () => this.wake(true));
    document.addEventListener("pointerdown", (event) => {
      if (!this.box.contains(event.target)) this.wake(false);
    });
    canvas.addEventListener(
      "wheel",
      () => {
        if (this.awake) {
          this.camera.isFitted = false;
          return;
        }
        find(".wheel").hidden = false;
        clearTimeout(this.hiding);
        this.hiding = setTimeout(() => {
          find(".wheel").hidden = true;
        }, 1500);
      },
      { passive: true },
    );
    canvas.addEventListener("keydown", (event) => this.key(event));
    canvas.addEventListener("pointermove", (event) => this.hover(event));
    canvas.addEventListener("pointerleave", () => find(".hover").replaceChildren());
  }

  buttons() {
    const { find, bodies } = this;
    const sizes = element(
      "button",
      { type: "button", "aria-pressed": "true", title: "Show or hide the dimensions" },
      "Sizes",
    );
    sizes.addEventListener("click", () => {
      this.sized = !this.sized;
      sizes.setAttribute("aria-pressed", String(this.sized));
      this.draw();
    });
    find(".views").replaceChildren(
      element("button", { type: "button", title: "Fit (F)", onclick: () => this.fit() }, "Fit"),
      ...Object.entries(VIEWS).map(([name, way], number) =>
        element(
          "button",
          {
            type: "button",
            title: `${name} (${number})`,
            onclick: () => {
              this.camera.look(way);
              this.fit();
            },
          },
          name,
        ),
      ),
      sizes,
    );
    roving(find(".views"));
    find(".step").addEventListener("input", (event) => this.data && this.go(Number(event.target.value)));
    find(".play").addEventListener("click", () => this.play());
    find(".colour").addEventListener("change", (event) => {
      bodies.field = event.target.value;
      if (this.data) this.go(bodies.step);
      if (this.camera.isFitted) this.fit();
    });
    find(".section").addEventListener("change", (event) => {
      Object.assign(bodies, { section: { axis: event.target.value, at: 0 }, isMoved: false });
      if (this.data) this.place(this.middle());
    });
  }

  play() {
    const button = this.find(".play");
    if (this.ticking) {
      clearInterval(this.ticking);
      this.ticking = null;
      button.textContent = "Play";
      return;
    }
    button.textContent = "Stop";
    this.ticking = setInterval(
      () => this.data && this.go((this.bodies.step + 1) % this.data.steps.length),
      TICK_MS,
    );
  }

  // The handle follows the mouse along its axis, and the arrow keys.
  dragged() {
    const handle = this.find(".handle"),
      { bodies } = this;
    let held = null;
    const along = () => {
      const axis = bodies.section.axis === "x" ? 0 : 1,
        unit = [0, 0, 0];
      const start = this.project(unit);
      unit[axis] = 1;
      const [x, y] = this.project(unit).map((one, i) => one - start[i]),
        square = x * x + y * y;
      return square > 25 ? [x / square, y / square] : [0, -1 / Math.sqrt(Math.max(square, 400))];
    };
    handle.addEventListener("pointerdown", (event) => {
      held = [event.clientX, event.clientY, bodies.section.at];
      handle.setPointerCapture(event.pointerId);
    });
    handle.addEventListener("pointermove", (event) => {
      if (!held) return;
      const [x, y] = along();
      bodies.isMoved = true;
      this.place(held[2] + (event.clientX - held[0]) * x + (event.clientY - held[1]) * y);
    });
    for (const kind of ["pointerup", "pointercancel"])
      handle.addEventListener(kind, () => {
        held = null;
      });
    handle.addEventListener("keydown", (event) => {
      const way = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 }[event.key];
      if (!way) return;
      const axis = bodies.section.axis === "x" ? 0 : 1;
      bodies.isMoved = true;
      this.place(bodies.section.at + (way * (bodies.high[axis] - bodies.low[axis])) / 40);
      event.preventDefault();
    });
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || !this.data) return;
    const { camera } = this,
      named = /^[0-6]$/.test(event.key) ? Object.values(VIEWS)[Number(event.key)] : null;
    const way = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (way && event.shiftKey) camera.shift(...way);
    else if (way) camera.turn(...way);
    else if (event.key === "+" || event.key === "-") camera.zoom(event.key === "+" ? 1.2 : 1 / 1.2);
    else if (event.key.toLowerCase() === "f") this.fit();
    else if (event.key === "Escape") this.wake(false);
    else if (named) {
      camera.look(named);
      this.fit();
    } else return;
    this.draw();
    event.preventDefault();
  }

  // The name and value of what is under the mouse, once it rests.
  hover(event) {
    clearTimeout(this.asking);
    if (event.buttons || !this.data) return;
    this.asking = setTimeout(() => {
      const box = this.canvas.getBoundingClientRect(),
        place = this.find(".hover"),
        { shown } = this.bodies;
      const x = event.clientX - box.left,
        y = event.clientY - box.top;
      const met = this.bodies.meets(this.camera.ray(x, y, box.width, box.height));
      const value =
        met && shown && typeof met.value === "number" ? `: ${spoken(met.value)} ${shown.unit}` : "";
      place.textContent = met ? met.name + value : "";
      place.style.left = `${Math.min(x + 14, box.width - 120)}px`;
      place.style.top = `${y + 10}px`;
    }, REST_MS);
  }
}
