// What is written over the 3D view: axes, scale bar, dimensions, the colour bar, the legend of the parts.
import { element, node, ticks } from "./dom.js";

const AXES = [
  ["x", [1, 0, 0]],
  ["y", [0, 1, 0]],
  ["z", [0, 0, 1]],
];
const plainly = (value) => String(Number(value.toPrecision(3)));
const LENGTHS = [1, 2, 5]
  .flatMap((one) => [-3, -2, -1, 0, 1, 2].map((power) => one * 10 ** power))
  .sort((a, b) => a - b);

// A length with its end marks; at: [x, y] of both ends in px; out: direction in which it stands off.
function length(from, to, out, words) {
  const [x1, y1, x2, y2] = [from[0] + out[0], from[1] + out[1], to[0] + out[0], to[1] + out[1]];
  const group = node("g", { class: "length" });
  group.append(
    node("path", { d: `M${from}L${x1} ${y1}M${to}L${x2} ${y2}`, class: "fine" }),
    node("path", { d: `M${x1} ${y1}L${x2} ${y2}` }),
  );
  const label = {
    x: (x1 + x2) / 2 + 0.35 * out[0],
    y: (y1 + y2) / 2 + 0.9 * out[1] + 4,
    "text-anchor": Math.abs(out[0]) < 5 ? "middle" : out[0] > 0 ? "start" : "end",
  };
  group.append(node("text", label, words));
  return group;
}

// Of the edges along an axis, the one that lies farthest out on the screen in a direction.
function outerEdge(low, high, axis, project, measure) {
  const others = [0, 1, 2].filter((one) => one !== axis);
  const edges = [0, 1, 2, 3].map((number) => {
    const from = [...low],
      to = [...low];
    to[axis] = high[axis];
    others.forEach((one, i) => {
      if ((number >> i) & 1) from[one] = to[one] = high[one];
    });
    return [project(from), project(to)];
  });
  return edges.sort((a, b) => measure(a) - measure(b))[3];
}

function dimensions(low, high, project) {
  const made = [],
    middle = (edge, i) => (edge[0][i] + edge[1][i]) / 2;
  const centre = project(low.map((one, i) => (one + high[i]) / 2));
  for (const axis of [0, 1, 2]) {
    const flat = outerEdge(
      low,
      high,
      axis,
      project,
      (edge) => middle(edge, axis === 2 ? 0 : 1) + (axis === 2 ? 0 : 1e-3 * edge.flat()[0]),
    );
    const long = Math.hypot(flat[1][0] - flat[0][0], flat[1][1] - flat[0][1]);
    if (long < 24) continue; // seen end-on
    const across = [-(flat[1][1] - flat[0][1]) / long, (flat[1][0] - flat[0][0]) / long];
    const outwards =
      (middle(flat, 0) - centre[0]) * across[0] + (middle(flat, 1) - centre[1]) * across[1] < 0 ? -1 : 1;
    made.push(
      length(
        flat[0],
        flat[1],
        across.map((one) => 14 * outwards * one),
        `${plainly(high[axis] - low[axis])} mm`,
      ),
    );
  }
  return made;
}

function axes(turn, height) {
  const group = node("g", { class: "axes", transform: `translate(44 ${height - 40})` });
  for (const [name, one] of AXES) {
    const [x, y] = turn(one).map((value) => 24 * value);
    group.append(
      node("path", { d: `M0 0L${x} ${-y}`, class: name }),
      node("text", { x: 1.35 * x, y: -1.35 * y + 4, "text-anchor": "middle" }, name),
    );
  }
  return group;
}

function scaleBar(pixels, width, height) {
  const most = Math.min(110, 0.25 * width),
    long = [...LENGTHS].reverse().find((one) => one * pixels <= most) || LENGTHS[0];
  const right = width - 54,
    left = right - long * pixels,
    y = height - 18;
  const group = node("g", { class: "scale" });
  const words = long < 0.1 ? `${plainly(1000 * long)} µm` : `${plainly(long)} mm`;
  group.append(
    node("path", { d: `M${left} ${y - 5}V${y}H${right}V${y - 5}` }),
    node("text", { x: (left + right) / 2, y: y - 6, "text-anchor": "middle" }, words),
  );
  return group;
}

// low, high: corners of the body in mm; project: mm -> px; turn: direction -> right and up; pixels: of a mm.
export function drawMarks(svg, { low, high, project, turn, pixels, width, height, withDimensions }) {
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  svg.replaceChildren(
    axes(turn, height),
    scaleBar(pixels, width, height),
    ...(withDimensions ? dimensions(low, high, project) : []),
  );
}

// The colours of a field with ticks below; top: of the data, in its unit.
export function colourBar(place, shown, top, map) {
  place.hidden = !shown;
  if (!shown) return;
  const low = shown.map ? -top : 0,
    stops = [];
  for (let i = 0; i <= 10; i++)
    stops.push(`rgb(${[...map.slice(3 * Math.round(25.5 * i), 3 * Math.round(25.5 * i) + 3)].join(",")})`);
  const bar = element("div", { class: "colours" });
  bar.style.background = `linear-gradient(to right,${stops.join(",")})`;
  const marks = ticks(low, top, 4).map((value) => {
    const tick = element("span", {}, plainly(value).replace("-", "−"));
    tick.style.left = `${(100 * (value - low)) / (top - low)}%`;
    return tick;
  });
  place.replaceChildren(
    element("span", { class: "name" }, `${shown.name} (${shown.unit})`),
    bar,
    element("div", { class: "ticks" }, ...marks),
  );
}

// A button for each part, which hides it; parts: [[name, colour], ...].
export function legend(place, parts, hidden, toggle) {
  place.replaceChildren(
    ...parts.map(([name, colour]) => {
      const patch = element("span", { class: "patch" });
      patch.style.background = `rgb(${colour.map((one) => Math.round(255 * one)).join(",")})`;
      const button = element(
        "button",
        { type: "button", "aria-pressed": String(!hidden[name]), title: `Hide or show: ${name}` },
        patch,
        name,
      );
      button.addEventListener("click", () => {
        button.setAttribute("aria-pressed", String(!toggle(name)));
      });
      return element("li", {}, button);
    }),
  );
}
