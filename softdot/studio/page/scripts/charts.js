// Curves and bars as SVG, which follows the colours of the page and can be read aloud.
import { short } from "./dom.js";

const SPACE = "http://www.w3.org/2000/svg";
function node(tag, attributes, text) {
  const made = document.createElementNS(SPACE, tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  if (text !== undefined) made.textContent = text;
  return made;
}

function ticks(low, high, count) {
  const rough = (high - low) / count, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((one) => one >= rough);
  const found = [];
  for (let at = Math.ceil(low / step - 1e-9) * step; at <= high + 1e-9 * step; at += step) found.push(Math.abs(at) < 1e-9 * step ? 0 : at);
  return found;
}

// series: [{x, y, kind: "now" | "faint" | "two", error}], the last drawn on top; bands: [{from, to, name}].
export function curves({ title, xLabel, yLabel, series, bands = [], width = 300, height = 190, marks = true }) {
  const chart = node("svg", { class: "chart", viewBox: `0 0 ${width} ${height}`, role: "img" });
  const [left, right, top, bottom] = [46, width - 8, 24, height - 32];
  const shown = series.map((one) => ({ ...one, points: one.x.map((x, i) => [x, one.y[i]]).filter(([x, y]) => x !== null && y !== null) }));
  const all = shown.flatMap((one) => one.points);
  const now = shown[shown.length - 1], last = now && now.points[now.points.length - 1];
  chart.append(node("title", {}, last ? `${title}: ${short(last[1])} ${yLabel} at ${short(last[0])} ${xLabel}` : title));
  chart.append(node("text", { x: left - 40, y: 14, class: "title" }, title + (yLabel ? ` (${yLabel})` : "")));
  if (!all.length) return chart;
  const errors = shown.flatMap((one) => (one.error ? one.points.slice(-1).flatMap(([, y]) => [y + one.error, y - one.error]) : []));
  const xs = all.map((point) => point[0]), ys = [0, ...all.map((point) => point[1]), ...errors];
  const [x0, x1] = [Math.min(...xs), Math.max(...xs)], [y0, y1] = [Math.min(...ys), Math.max(...ys)];
  const X = (x) => left + ((x - x0) / (x1 - x0 || 1)) * (right - left), Y = (y) => bottom - ((y - y0) / (y1 - y0 || 1)) * (bottom - top);
  for (const band of bands) {
    const at = X(Math.max(band.from, x0)), wide = X(Math.min(band.to, x1)) - at;
    const fill = ["#009e73", "#0072b2", "#cc79a7", "#e69f00", "#999999"][band.kind % 5];
    const drawn = node("rect", { class: "band", x: at, y: top, width: Math.max(wide, 0), height: bottom - top, fill });
    drawn.append(node("title", {}, band.name));
    chart.append(drawn);
  }
  for (const y of ticks(y0, y1 > y0 ? y1 : y0 + 1, 4)) {
    chart.append(node("line", { class: "grid", x1: left, x2: right, y1: Y(y), y2: Y(y) }));
    chart.append(node("text", { x: left - 5, y: Y(y) + 4, "text-anchor": "end" }, short(y)));
  }
  for (const x of ticks(x0, x1 > x0 ? x1 : x0 + 1, 4)) chart.append(node("text", { x: X(x), y: bottom + 14, "text-anchor": "middle" }, short(x)));
  chart.append(node("text", { x: (left + right) / 2, y: height - 4, "text-anchor": "middle" }, xLabel));
  for (const one of shown) {
    const path = one.points.map(([x, y], i) => `${i ? "L" : "M"}${X(x).toFixed(1)} ${Y(y).toFixed(1)}`).join("");
    chart.append(node("path", { class: `line ${one.kind}`, d: path }));
    if (one.kind !== "now" || !marks) continue;
    for (const [x, y] of one.points) chart.append(node("circle", { class: "mark", cx: X(x), cy: Y(y), r: 2.6 }));
    if (!one.error) continue;
    const [x, y] = one.points[one.points.length - 1], [low, high] = [Y(y - one.error), Y(y + one.error)];
    chart.append(node("path", { class: "error", d: `M${X(x) - 4} ${low}h8M${X(x) - 4} ${high}h8M${X(x)} ${low}V${high}` }));
  }
  return chart;
}

// rows: [{label, value}], in percent; the largest first.
export function tornado(rows, unit = "%") {
  const line = 36, width = 330, height = rows.length * line + 6, middle = width / 2;
  const chart = node("svg", { class: "chart", viewBox: `0 0 ${width} ${height}`, role: "img" });
  const most = Math.max(...rows.map((row) => Math.abs(row.value)), 1e-9);
  chart.append(node("title", {}, rows.map((row) => `${row.label}: ${short(row.value)} ${unit}`).join("; ")));
  rows.forEach((row, i) => {
    const wide = (Math.abs(row.value) / most) * (middle - 58), y = i * line + 17;
    chart.append(node("text", { x: middle, y: y - 4, "text-anchor": "middle" }, row.label));
    chart.append(node("rect", { class: row.value < 0 ? "bar minus" : "bar", x: row.value < 0 ? middle - wide : middle, y, width: wide, height: 11, rx: 2 }));
    chart.append(node("line", { class: "grid", x1: middle, x2: middle, y1: y - 1, y2: y + 12 }));
    const beside = row.value < 0 ? middle - wide - 4 : middle + wide + 4;
    chart.append(node("text", { x: beside, y: y + 10, "text-anchor": row.value < 0 ? "end" : "start" }, `${row.value > 0 ? "+" : "−"}${Math.abs(row.value).toFixed(Math.abs(row.value) < 100 ? 1 : 0)} ${unit}`));
  });
  return chart;
}

// An array from above: each segment with a bar as high as its voltage; places: [{label, at: [x, y], volts}], in mm.
export function segments({ places, dots, size, half }) {
  const scale = Math.min(64 / Math.min(...size), 560 / (2 * half[0])), margin = 6;
  const [width, height] = half.map((one) => 2 * one * scale + 2 * margin), [w, h] = size.map((one) => one * scale);
  const X = (x) => margin + (x + half[0]) * scale, Y = (y) => margin + (y + half[1]) * scale;
  const most = Math.max(...places.map((one) => Math.abs(one.volts || 0)), 1e-12), room = h - 32;
  const chart = node("svg", { class: "chart array", viewBox: `0 0 ${width} ${height}`, role: "img" });
  const said = places.map((one) => `${one.label} ${one.volts === null ? "not pressed yet" : `${short(one.volts)} V`}`).join(", ");
  chart.append(node("title", {}, `Voltages of the segments: ${said}`));
  for (const { label, at, volts } of places) {
    const [left, top] = [X(at[0]) - w / 2, Y(at[1]) - h / 2];
    chart.append(node("rect", { class: "segment", x: left, y: top, width: w, height: h, rx: 3 }));
    const tall = (Math.abs(volts || 0) / most) * room;
    if (volts !== null) chart.append(node("rect", { class: volts < 0 ? "bar minus" : "bar", x: left + w - 16, y: top + 4 + room - tall, width: 10, height: tall }));
    chart.append(node("text", { x: left + 5, y: top + 14 }, label));
    if (volts !== null) chart.append(node("text", { class: "title", x: X(at[0]), y: top + h - 9, "text-anchor": "middle" }, `${volts.toPrecision(3)} V`));
  }
  for (const [x, y] of dots) chart.append(node("circle", { class: "ring", cx: X(x) - 8, cy: Y(y) - 3, r: 0.15 * h }));
  return chart;
}
