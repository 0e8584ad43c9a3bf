// What the 3D view draws: the parts, the face of a section, and the dot. Data: export/solid_view.py.
import * as THREE from "./three.module.min.js";
import { sliced } from "./slice.js";

const MOST_PARTS = 16;
const FAR = 1e9;
// What can be shown: its unit, on which parts, in which colours; what lies above the film is hidden for the film.
export const FIELDS = {
  stress: { name: "von Mises stress", unit: "MPa", factor: 1, on: (part, film) => part !== film },
  strain: { name: "film strain", unit: "%", factor: 100, on: (part, film) => part === film, bare: true },
  charge: {
    name: "charge density",
    unit: "pC/mm²",
    factor: 1,
    on: (part, film) => part === film,
    bare: true,
    map: "diverging",
  },
  pressure: { name: "contact pressure", unit: "MPa", factor: 1, on: (part, _, top) => part === top },
};

// Flat normals come from screen derivatives. A back face is seen only where a section opens a part: it is filled.
const VERTEX = `
  attribute vec3 rest; attribute vec4 paint; attribute float part;
  uniform vec3 move;
  varying vec3 seen; varying vec3 shade; varying vec3 restAt; varying float partOf;
  void main() {
    vec4 inView = modelViewMatrix * vec4(position + move, 1.0);
    seen = inView.xyz; shade = paint.rgb; restAt = rest + move; partOf = part;
    gl_Position = projectionMatrix * inView;
  }`;
const FRAGMENT = `
  uniform vec4 plane; uniform float hidden[${MOST_PARTS}]; uniform float capped;
  varying vec3 seen; varying vec3 shade; varying vec3 restAt; varying float partOf;
  void main() {
    if (dot(plane.xyz, restAt) < plane.w || hidden[int(partOf + 0.5)] > 0.5) discard;
    vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
    float light = 0.55 + 0.45 * abs(dot(normal, normalize(vec3(-0.35, 0.5, 0.8))));
    gl_FragColor = vec4(shade * (capped > 1.5 || (capped > 0.5 && !gl_FrontFacing) ? 0.93 : light), 1.0);
  }`;

// capped: 0 nowhere, 1 on back faces, 2 everywhere (a mesh of back faces, which the library turns).
// Parts lie in front of the cut face of the dot only where their triangles, which are flat, reach into it: where that
// face is seen, the stencil keeps them out.
const CUT_OF_DOT = 1;

function material(capped, side, stencil) {
  const uniforms = {
    plane: { value: new THREE.Vector4(0, 0, 0, -FAR) },
    move: { value: new THREE.Vector3() },
    hidden: { value: new Array(MOST_PARTS).fill(0) },
    capped: { value: capped },
  };
  return new THREE.ShaderMaterial({
    uniforms,
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    side,
    stencilWrite: true,
    ...stencil,
  });
}

function geometry(place, rest, paint, part, index) {
  const made = new THREE.BufferGeometry();
  made.setAttribute("position", new THREE.BufferAttribute(place, 3));
  made.setAttribute("rest", new THREE.BufferAttribute(rest, 3));
  made.setAttribute("paint", new THREE.BufferAttribute(paint, 4, true));
  made.setAttribute("part", new THREE.BufferAttribute(part, 1));
  if (index) made.setIndex(new THREE.BufferAttribute(index, 1));
  made.boundingSphere = new THREE.Sphere(new THREE.Vector3(), FAR);
  return made;
}

export class Bodies {
  constructor() {
    this.scene = new THREE.Scene();
    this.data = null;
    this.hidden = {};
    this.step = 0;
    this.field = "part";
    this.section = { axis: "y", at: 0 };
    this.isMoved = false; // somebody has moved the section
    const beside = { stencilRef: CUT_OF_DOT, stencilFunc: THREE.NotEqualStencilFunc };
    const marking = (ref) => ({
      stencilRef: ref,
      stencilFunc: THREE.AlwaysStencilFunc,
      stencilZPass: THREE.ReplaceStencilOp,
    });
    const made = (...of) => new THREE.Mesh(new THREE.BufferGeometry(), material(...of));
    this.parts = made(1, THREE.DoubleSide, beside);
    this.face = made(0, THREE.DoubleSide, beside);
    this.dots = [made(0, THREE.FrontSide, marking(0)), made(2, THREE.BackSide, marking(CUT_OF_DOT))];
    this.scene.add(...this.dots, this.parts, this.face);
    [...this.dots, this.parts, this.face].forEach((mesh, i) => {
      mesh.renderOrder = i;
      mesh.frustumCulled = false;
    });
  }

  load(data) {
    this.data = data;
    const count = data.points.length / 3,
      dots = data.dotPoints.length / 3;
    this.film = data.names.indexOf("film");
    this.replace(
      this.parts,
      geometry(
        new Float32Array(data.points),
        data.points,
        new Uint8Array(4 * count),
        Float32Array.from(data.region),
        data.triangles,
      ),
    );
    const paint = new Uint8Array(4 * dots);
    for (let i = 0; i < paint.length; i++) paint[i] = i % 4 < 3 ? 255 * data.dotColour[i % 4] : 255;
    const dot = geometry(data.dotPoints, data.dotPoints, paint, new Float32Array(dots).fill(MOST_PARTS - 1));
    for (const mesh of this.dots) this.replace(mesh, dot);
    this.low = [Infinity, Infinity, Infinity];
    this.high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < data.points.length; i++) {
      this.low[i % 3] = Math.min(this.low[i % 3], data.points[i]);
      this.high[i % 3] = Math.max(this.high[i % 3], data.points[i]);
    }
  }

  // The section stays inside the body.
  settle(at) {
    const axis = this.section.axis === "x" ? 0 : 1,
      inset = 1e-4 * (this.high[axis] - this.low[axis]);
    this.section.at = Math.min(this.high[axis] - inset, Math.max(this.low[axis] + inset, at));
  }

  replace(mesh, made) {
    mesh.geometry.dispose();
    mesh.geometry = made;
  }

  // The field that is shown: the chosen one, where the data have it.
  get shown() {
    return this.data && this.data[this.field] ? FIELDS[this.field] : null;
  }

  update() {
    const { data, shown } = this,
      values = shown && data[this.field];
    const place = this.parts.geometry.attributes.position.array,
      paint = this.parts.geometry.attributes.paint.array;
    const from = this.step * place.length,
      unit = data.displacementUnit,
      moved = data.displacement;
    for (let i = 0; i < place.length; i++) place[i] = data.points[i] + unit * moved[from + i];
    const map = data[(shown && shown.map) || "colourMap"],
      count = place.length / 3,
      top = data.names.length - 1;
    const plain = data.colours.map((colour) => colour.map((one) => 255 * one));
    const painted = data.names.map((_, part) => Boolean(shown) && shown.on(part, this.film, top));
    for (let i = 0, k = this.step * count; i < count; i++, k++) {
      const part = data.region[i],
        source = painted[part] ? map : plain[part],
        at = painted[part] ? 3 * values[k] : 0;
      paint[4 * i] = source[at];
      paint[4 * i + 1] = source[at + 1];
      paint[4 * i + 2] = source[at + 2];
    }
    for (const name of ["position", "paint"]) this.parts.geometry.attributes[name].needsUpdate = true;
    for (const { material: own } of this.dots) own.uniforms.move.value.fromArray(data.dotShift[this.step]);
    this.cut();
  }

  // Which parts are not drawn: those that somebody hid, and what lies above the film while it is looked at.
  gone(part) {
    const { shown } = this,
      above = shown && shown.bare && this.film >= 0 && part > this.film;
    return Boolean(this.hidden[this.data.names[part]] || above);
  }

  cut() {
    const { data, section } = this,
      axis = "xyz".indexOf(section.axis),
      there = axis >= 0 && !data.slice;
    const gone = data.names.map((_, part) => this.gone(part));
    const sign = section.axis === "x" ? -1 : 1,
      normal = [0, 1, 2].map((i) => (there && i === axis ? sign : 0));
    for (const mesh of [this.parts, ...this.dots]) {
      mesh.material.uniforms.plane.value.set(...normal, there ? sign * section.at : -FAR);
      mesh.material.uniforms.hidden.value = Array.from({ length: MOST_PARTS }, (_, part) =>
        gone[part] ? 1 : 0,
      );
    }
    for (const mesh of this.dots) mesh.visible = !this.hidden.dot && (!this.shown || this.field === "stress");
    this.face.visible = there && data.tets.length > 0;
    this.parts.material.uniforms.capped.value = this.face.visible ? 0 : 1; // the face of the section fills it
    if (!this.face.visible) return;
    const { position, paint } = this.parts.geometry.attributes;
    const made = sliced(data, position.array, paint.array, axis, section.at, gone);
    this.source = made.source;
    this.replace(this.face, geometry(made.place, made.place, made.paint, made.part, null));
  }

  // What a ray meets first that is drawn: its name, and the value there.
  meets(ray) {
    const { plane } = this.parts.material.uniforms,
      behind = plane.value;
    const hits = ray.intersectObjects(
      [this.parts, this.face].filter((one) => one.visible),
      false,
    );
    const [dot] = this.dots,
      { move } = dot.material.uniforms;
    if (dot.visible) {
      ray.ray.origin.sub(move.value);
      hits.push(...this.dots.flatMap((one) => ray.intersectObject(one, false)));
      hits.sort((a, b) => a.distance - b.distance);
    }
    const { rest } = this.parts.geometry.attributes,
      at = new THREE.Vector3();
    for (const hit of hits) {
      if (this.dots.includes(hit.object)) {
        at.copy(hit.point).add(move.value);
        if (behind.x * at.x + behind.y * at.y + behind.z * at.z >= behind.w) return { name: "dot" };
        continue;
      }
      const node = hit.object === this.face ? this.source[hit.face.a] : hit.face.a;
      at.fromBufferAttribute(rest, node);
      const part = this.data.region[node],
        open = behind.x * at.x + behind.y * at.y + behind.z * at.z < behind.w;
      if (this.gone(part) || (hit.object === this.parts && open)) continue;
      return { name: this.data.names[part], value: this.value(node, part) };
    }
    return null;
  }

  value(node, part) {
    const { shown, data } = this;
    if (!shown || !shown.on(part, this.film, data.names.length - 1)) return null;
    const share = data[this.field][(this.step * data.points.length) / 3 + node] / 255,
      top = shown.factor * data.tops[this.field];
    return shown.map ? top * (2 * share - 1) : top * share;
  }
}
