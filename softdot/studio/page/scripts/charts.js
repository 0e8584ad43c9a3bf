// Bars as SVG, which follow the colours of the page and can be read aloud, and a channel of a recording.
import { node, short, ticks } from "./dom.js";

// A channel over time; bands: [{from, to, name, kind}] are the phases.
export function channel({ title, unit, x, y, bands, width = 340, height = 150 }) {
  const chart = node("svg", { class: "chart", viewBox: `0 0 ${width} ${height}`, role: "img" });
  const [left, right, top, bottom] = [46, width - 8, 24, height - 32];
  const points = x.map((at, i) => [at, y[i]]).filter(([at, value]) => at !== null && value !== null);
  chart.append(
    node(
      "title",
      {},
      points.length ? `${title}: ${short(points[points.length - 1][1])} ${unit} at the end` : title,
    ),
  );
  chart.append(node("text", { x: 6, y: 14, class: "title" }, title + (unit ? ` (${unit})` : "")));
  if (!points.length) return chart;
  const xs = points.map((one) => one[0]),
    ys = [0, ...points.map((one) => one[1])];
  const [x0, x1, y0, y1] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  const X = (at) => left + ((at - x0) / (x1 - x0 || 1)) * (right - left);
  const Y = (value) => bottom - ((value - y0) / (y1 - y0 || 1)) * (bottom - top);
  for (const band of bands) {
    const at = X(Math.max(band.from, x0)),
      wide = X(Math.min(band.to, x1)) - at;
    const fill = ["#009e73", "#0072b2", "#cc79a7", "#e69f00", "#999999"][band.kind % 5];
    const drawn = node("rect", {
      class: "band",
      x: at,
      y: top,
      width: Math.max(wide, 0),
      height: bottom - top,
      fill,
    });
    drawn.append(node("title", {}, band.name));
    chart.append(drawn);
  }
  for (const value of ticks(y0, y1 > y0 ? y1 : y0 + 1, 4)) {
    chart.append(node("line", { class: "grid", x1: left, x2: right, y1: Y(value), y2: Y(value) }));
    chart.append(node("text", { x: left - 5, y: Y(value) + 4, "text-anchor": "end" }, short(value)));
  }
  for (const at of ticks(x0, x1 > x0 ? x1 : x0 + 1, 4)) {
    chart.append(node("text", { x: X(at), y: bottom + 14, "text-anchor": "middle" }, short(at)));
  }
  chart.append(node("text", { x: (left + right) / 2, y: height - 4, "text-anchor": "middle" }, "time (s)"));
  const path = points
    .map(([at, value], i) => `${i ? "L" : "M"}${X(at).toFixed(1)} ${Y(value).toFixed(1)}`)
    .join("");
  chart.append(node("path", { class: "line", d: path }));
  return chart;
}

// rows: [{label, value}], in percent; the largest first.
export function tornado(rows, unit = "%") {
  const line = 36,
    width = 330,
    height = rows.length * line + 6,
    middle = width / 2;
  const chart = node("svg", { class: "chart", viewBox: `0 0 ${width} ${height}`, role: "img" });
  const most = Math.max(...rows.map((row) => Math.abs(row.value)), 1e-9);
  chart.append(node("title", {}, rows.map((row) => `${row.label}: ${short(row.value)} ${unit}`).join("; ")));
  rows.forEach((row, i) => {
    const wide = (Math.abs(row.value) / most) * (middle - 58),
      y = i * line + 17;
    chart.append(node("text", { x: middle, y: y - 4, "text-anchor": "middle" }, row.label));
    chart.append(
      node("rect", {
        class: row.value < 0 ? "bar minus" : "bar",
        x: row.value < 0 ? middle - wide : middle,
        y,
        width: wide,
        height: 11,
        rx: 2,
      }),
    );
    chart.append(node("line", { class: "grid", x1: middle, x2: middle, y1: y - 1, y2: y + 12 }));
    const beside = row.value < 0 ? middle - wide - 4 : middle + wide + 4;
    chart.append(
      node(
        "text",
        { x: beside, y: y + 10, "text-anchor": row.value < 0 ? "end" : "start" },
        `${row.value > 0 ? "+" : "−"}${Math.abs(row.value).toFixed(Math.abs(row.value) < 100 ? 1 : 0)} ${unit}`,
      ),
    );
  });
  return chart;
}

// An array from above: each segment with a bar as high as its voltage; places: [{label, at: [x, y], volts}], in mm.
export function segments({ places, dots, size, half }) {
  const scale = Math.min(64 / Math.min(...size), 560 / (2 * half[0])),
    margin = 6;
  const [width, height] = half.map((one) => 2 * one * scale + 2 * margin),
    [w, h] = size.map((one) => one * scale);
  const X = (x) => margin + (x + half[0]) * scale,
    Y = (y) => margin + (y + half[1]) * scale;
  const most = Math.max(...places.map((one) => Math.abs(one.volts || 0)), 1e-12),
    room = h - 32;
  const chart = node("svg", { class: "chart array", viewBox: `0 0 ${width} ${height}`, role: "img" });
  const said = places
    .map((one) => `${one.label} ${one.volts === null ? "not pressed yet" : `${short(one.volts)} V`}`)
    .join(", ");
  chart.append(node("title", {}, `Voltages of the segments: ${said}`));
  for (const { label, at, volts } of places) {
    const [left, top] = [X(at[0]) - w / 2, Y(at[1]) - h / 2];
    chart.append(node("rect", { class: "segment", x: left, y: top, width: w, height: h, rx: 3 }));
    const tall = (Math.abs(volts || 0) / most) * room;
    if (volts !== null)
      chart.append(
        node("rect", {
          class: volts < 0 ? "bar minus" : "bar",
          x: left + w - 16,
          y: top + 4 + room - tall,
          width: 10,
          height: tall,
        }),
      );
    chart.append(node("text", { x: left + 5, y: top + 14 }, label));
    if (volts !== null)
      chart.append(
        node(
          "text",
          { class: "title", x: X(at[0]), y: top + h - 9, "text-anchor": "middle" },
          `${volts.toPrecision(3)} V`,
        ),
      );
  }
  for (const [x, y] of dots)
    chart.append(node("circle", { class: "ring", cx: X(x) - 8, cy: Y(y) - 3, r: 0.15 * h }));
  return chart;
}
