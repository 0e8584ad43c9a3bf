"use strict";
// Plays a reading: the line of dots moves under the array, its voltages scroll, the text appears. Data: see
// player_data in export/array/reading_page.py.
function softdotReading(root, data) {
  const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
  const time = new Float32Array(bytes(data.time)), position = new Float32Array(bytes(data.position));
  const low = new Int16Array(bytes(data.low)), high = data.high ? new Int16Array(bytes(data.high)) : low;
  const count = time.length, unit = data.top / 32767, begin = time[0], end = time[count - 1];
  const [dotX, dotY, dotHeight] = data.dots, reads = data.readTime, channels = data.labels.length;
  const find = (selector) => root.querySelector(selector);
  const line = find(".line"), traces = find(".traces"), scrub = find(".scrub"), play = find(".play"), clock = find(".clock");
  const cells = [...root.querySelectorAll(".cells > span")], said = cells.map((cell) => cell.firstChild.data);
  const calm = window.matchMedia("(prefers-reduced-motion: reduce)");
  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  const half = [0, 1].map((axis) => Math.max(...data.centres.map((at) => Math.abs(at[axis]))) + data.size[axis] / 2);
  const live = find(".said"), sound = find(".sound"), unsure = cells.map((cell) => cell.classList.contains("unsure"));
  const pace = reads.length > 1 ? (reads[reads.length - 1] - reads[0]) / (reads.length - 1) : (end - begin) / 10;
  const least = Math.min(0, low.reduce((a, b) => Math.min(a, b), 0)) * unit, most = high.reduce((a, b) => Math.max(a, b), 0) * unit;
  const scale = data.top < 1 ? 1000 : 1, word = data.top < 1 ? "mV" : "V";
  const state = { now: begin, shown: cells.length, playing: false, tick: 0, colours: {}, audio: null };

  // Number of entries of an ascending list that are at most a value.
  function before(list, value) {
    let a = 0, b = list.length;
    while (a < b) {
      const middle = (a + b) >> 1;
      if (list[middle] <= value) a = middle + 1; else b = middle;
    }
    return a;
  }

  function place() {
    const k = Math.max(1, Math.min(count - 1, before(time, state.now)));
    const share = Math.max(0, Math.min(1, (state.now - time[k - 1]) / (time[k] - time[k - 1] || 1)));
    return position[k - 1] + share * (position[k] - position[k - 1]);
  }

  // The present voltage of a segment: of its bin the end that is farther from zero.
  function present(channel) {
    const k = channel * count + Math.max(0, before(time, state.now) - 1);
    return unit * (Math.abs(low[k]) > Math.abs(high[k]) ? low[k] : high[k]);
  }

  const number = (value) => rounded(scale * value).replace("-", "−");

  // Three digits, and no more of them behind the point than the largest voltage shows.
  function rounded(value) {
    return (value || 0).toFixed(Math.max(0, 2 - Math.floor(Math.log10(scale * data.top))));
  }

  function learnColours() {
    const style = getComputedStyle(document.documentElement);
    for (const name of ["ink", "soft", "line", "card", "red", "amber", "plus", "minus", "dot", "accent"]) {
      state.colours[name] = style.getPropertyValue("--" + name).trim();
    }
  }

  // A canvas as sharp as the screen, empty, in pixels of the page. Its size is asked for and set when it changes alone:
  // either makes the browser lay out the whole text.
  function cleared(canvas, height) {
    const ratio = window.devicePixelRatio || 1, width = state.width, pen = canvas.getContext("2d");
    const [wide, tall] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (canvas.width !== wide || canvas.height !== tall) {
      canvas.style.height = height + "px";
      canvas.width = wide;
      canvas.height = tall;
    }
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    return [pen, width];
  }

  function measure() {
    state.width = line.clientWidth;
    draw();
  }

  function disc(pen, x, y, radius, filled) {
    pen.beginPath();
    pen.arc(x, y, Math.max(0, radius), 0, 2 * Math.PI);
    if (filled) pen.fill(); else pen.stroke();
  }

  function drawDots(pen, colours, at, size, from, to) {
    pen.strokeStyle = pen.fillStyle = colours.dot;
    pen.lineWidth = 1;
    for (let k = before(dotX, from); k < dotX.length && dotX[k] < to; k++) {
      const [x, y] = at(dotX[k], dotY[k]), full = 0.5 * data.dot.base * size;
      disc(pen, x, y, full, false);
      disc(pen, x, y, full * Math.min(1.2, dotHeight[k] / data.dot.height), true);
    }
  }

  function drawSegment(pen, colours, channel, at, size, here) {
    const value = present(channel), [w, h] = data.size.map((side) => side * size);
    const [x, y] = at(here + data.centres[channel][0], data.centres[channel][1]);
    pen.globalAlpha = 0.75 * Math.sqrt(Math.abs(value) / data.top);
    pen.fillStyle = value < 0 ? colours.minus : colours.plus;
    pen.fillRect(x - w / 2, y - h / 2, w, h);
    pen.globalAlpha = 1;
    pen.strokeStyle = colours.ink;
    pen.lineWidth = 1.5;
    pen.strokeRect(x - w / 2, y - h / 2, w, h);
    if (w < 34 || h < 34) return;
    pen.fillStyle = colours.ink;
    for (const [words, down] of [[data.labels[channel], 13 - h / 2], [number(value), h / 2 - 5]]) outlined(pen, colours, words, x, y + down);
  }

  function outlined(pen, colours, words, x, y) {
    pen.lineWidth = 3;
    pen.strokeStyle = colours.card;
    pen.strokeText(words, x, y);
    pen.fillText(words, x, y);
  }

  // The cell that was read, and below it a bar that is as full as the decoder is certain.
  function drawRead(pen, colours, x, y, k, font) {
    const wrong = cells[k].classList.contains("wrong");
    pen.font = (wrong ? "bold " : "") + font;
    pen.fillStyle = wrong ? colours.red : unsure[k] ? colours.amber : colours.ink;
    pen.fillText(said[k] + (wrong ? " ✗" : ""), x, y);
    if (!data.certain || data.certain[k] < 0) return;
    pen.strokeStyle = colours.soft;
    pen.lineWidth = 1;
    pen.strokeRect(x - 12.5, y + 5.5, 25, 4);
    pen.fillRect(x - 12.5, y + 5.5, 25 * data.certain[k], 4);
  }

  function drawLine() {
    const colours = state.colours, tall = 2 * half[1], spare = 38;
    const size = Math.max(6, Math.min(22, state.width / (2 * half[0] + 12)));
    const height = Math.round((tall + 2.5) * size + spare), middle = (height - spare) / 2;
    const [pen, width] = cleared(line, height), here = place(), across = width / 2 / size;
    const at = (x, y) => [width / 2 + (x - here) * size, middle + y * size];
    drawDots(pen, colours, at, size, here - across - 3, here + across + 3);
    pen.textAlign = "center";
    pen.font = "11px system-ui, sans-serif";
    for (let channel = 0; channel < channels; channel++) drawSegment(pen, colours, channel, at, size, here);
    for (let k = 0; k < data.cellX.length; k++) {
      if (reads[k] > state.now || Math.abs(data.cellX[k] - here) > across + 3) continue;
      drawRead(pen, colours, at(data.cellX[k], 0)[0], height - 15, k, "20px 'DejaVu Sans', 'Apple Braille', 'Segoe UI Symbol', sans-serif");
    }
    if (!state.playing) line.setAttribute("aria-label", "The line of dots under the array, whose middle is at " + here.toFixed(1) + " mm; "
      + data.labels.map((label, k) => label + " " + number(present(k)) + " " + word).join(", "));
  }

  // A step of 1, 2 or 5 times a power of ten, about a fifth of a range.
  function stepOf(range) {
    const power = 10 ** Math.floor(Math.log10(range / 5)), share = range / 5 / power;
    return power * (share < 1.5 ? 1 : share < 3.5 ? 2 : 5);
  }

  function drawAxis(pen, colours, x, from, to, top, bottom, width) {
    const step = stepOf(to - from), digits = Math.max(0, -Math.floor(Math.log10(step)));
    pen.textAlign = "center";
    pen.font = "12px system-ui, sans-serif";
    for (let tick = Math.ceil(from / step); tick * step <= to; tick++) {
      const seconds = tick * step;
      if (seconds < begin || seconds > end) continue;
      pen.fillStyle = colours.line;
      pen.fillRect(x(seconds), top, 1, bottom - top);
      pen.fillStyle = colours.soft;
      if (x(seconds) < width - 24) pen.fillText(seconds.toFixed(digits) + " s", x(seconds), bottom + 15);
    }
  }

  function drawTrace(pen, channel, x, y, from, to) {
    const last = Math.min(count - 1, before(time, to) - 1);
    pen.beginPath();
    for (let k = Math.max(0, before(time, from) - 1); k <= last; k++) {
      pen.lineTo(x(time[k]), y(unit * low[channel * count + k]));
      if (high !== low) pen.lineTo(x(time[k]), y(unit * high[channel * count + k]));
    }
    pen.stroke();
  }

  // The place of the array's middle along the line, from the least to the largest one that is seen.
  function drawCourse(pen, x, from, to, top, lane) {
    const first = Math.max(0, before(time, from) - 1), last = Math.min(count - 1, before(time, to) - 1);
    let [near, far] = [Infinity, -Infinity];
    for (let k = first; k <= last; k++) [near, far] = [Math.min(near, position[k]), Math.max(far, position[k])];
    pen.beginPath();
    for (let k = first; k <= last; k++) pen.lineTo(x(time[k]), top + lane * (0.92 - (0.84 * (position[k] - near)) / (far - near || 1)));
    pen.stroke();
  }

  function drawTraces() {
    const colours = state.colours, lane = channels > 12 ? 22 : 42, height = (channels + 1) * lane + 26, gutter = 52;
    const [pen, width] = cleared(traces, height), span = pace * Math.max(4, width / 90);
    const from = state.now - 0.9 * span, to = from + span, right = width - 6;
    const x = (seconds) => gutter + ((seconds - from) / span) * (right - gutter);
    drawAxis(pen, colours, x, Math.max(from, begin), to, 4, height - 22, width);
    pen.lineJoin = "round";
    for (let channel = 0; channel < channels; channel++) {
      const lower = 4 + (channel + 0.96) * lane, y = (value) => lower - ((value - least) / (most - least || 1)) * 0.88 * lane;
      pen.fillStyle = colours.line;
      pen.fillRect(gutter, y(0), right - gutter, 1);
      pen.save();
      pen.beginPath();
      pen.rect(gutter, 0, right - gutter, height);
      pen.clip();
      pen.strokeStyle = colours.minus;
      pen.lineWidth = 1.6;
      drawTrace(pen, channel, x, y, from, state.now);
      pen.restore();
      pen.fillStyle = colours.ink;
      pen.textAlign = "left";
      pen.fillText(data.labels[channel], 10, lower - 0.44 * lane + 4);
    }
    pen.save();
    pen.beginPath();
    pen.rect(gutter, 0, right - gutter, height);
    pen.clip();
    pen.strokeStyle = colours.accent;
    drawCourse(pen, x, from, state.now, 4 + channels * lane, lane);
    pen.restore();
    pen.fillText("place", 10, 4 + (channels + 0.5) * lane + 4);
    pen.fillStyle = colours.ink;
    pen.fillRect(x(state.now), 4, 1.5, height - 26);
  }

  function appear() {
    const shown = before(reads, state.now);
    for (let k = Math.min(shown, state.shown); k < Math.max(shown, state.shown); k++) cells[k].classList.toggle("unread", k >= shown);
    if (shown === state.shown + 1 && sound.checked) hear(shown - 1);
    state.shown = shown;
  }

  // Numbers of the raised dots of the cell that was read.
  function dotsOf(k) {
    const bits = said[k].codePointAt(0) - 0x2800;
    return bits > 0 && bits < 64 ? [1, 2, 3, 4, 5, 6].filter((dot) => (bits >> (dot - 1)) & 1) : [];
  }

  function tone(hertz, after, kind) {
    const audio = state.audio, source = audio.createOscillator(), level = audio.createGain(), at = audio.currentTime + after;
    source.type = kind;
    source.frequency.value = hertz;
    level.gain.setValueAtTime(0.08, at);
    level.gain.exponentialRampToValueAtTime(0.001, at + 0.11);
    source.connect(level).connect(audio.destination);
    source.start(at);
    source.stop(at + 0.12);
  }

  // The dots of a cell as notes, upper ones higher, the left column first; a cell that is not certain as a low buzz.
  function hear(k) {
    state.audio = state.audio || new AudioContext();
    if (unsure[k]) tone(98, 0, "square");
    for (const dot of dotsOf(k)) tone([784, 587, 440][(dot - 1) % 3], dot > 3 ? 0.07 : 0, "sine");
  }

  // What a reader of the screen says of the cell that was read last.
  function tell() {
    const k = state.shown - 1;
    if (k < 0) return void (live.textContent = "");
    const dots = dotsOf(k).join(" "), sure = data.certain ? data.certain[k] : -1;
    const what = unsure[k] ? "not certain" : dots ? "dots " + dots : "blank";
    live.textContent = "Cell " + (k + 1) + " of " + cells.length + ": " + what + (cells[k].classList.contains("wrong") ? ", wrong" : "")
      + (sure >= 0 ? ", probability " + (100 * sure).toFixed(1) + " %" : "");
  }

  function draw() {
    drawLine();
    drawTraces();
    appear();
    const words = (state.now - begin).toFixed(2) + " s of " + (end - begin).toFixed(2) + " s";
    clock.textContent = words;
    scrub.value = String(Math.round((1000 * (state.now - begin)) / (end - begin)));
    scrub.setAttribute("aria-valuetext", words + ", " + state.shown + " of " + cells.length + " cells");
  }

  function go(seconds) {
    state.now = Math.max(begin, Math.min(end, seconds));
    draw();
  }

  // To the time at which the next or the previous cell is read.
  function toCell(by) {
    const shown = before(reads, state.now + 1e-6 * by) + (by > 0 ? 0 : -2);
    go(shown < 0 ? begin : shown >= reads.length ? end : reads[shown] + 1e-5);
  }

  function stop() {
    state.playing = false;
    window.cancelAnimationFrame(state.tick);
    window.clearTimeout(state.later);
    play.textContent = "Play";
    draw();
  }

  // Where motion is not wanted, from cell to cell.
  function advance(last) {
    if (state.now >= end) return stop();
    const speed = Number(find(".speed").value);
    if (calm.matches) {
      state.later = window.setTimeout(() => { toCell(1); advance(0); }, Math.max(250, (1000 * pace) / speed));
      return;
    }
    state.tick = window.requestAnimationFrame((stamp) => {
      if (last) go(state.now + (speed * Math.min(200, stamp - last)) / 1000);
      advance(stamp);
    });
  }

  function toggle() {
    if (state.playing) return stop();
    if (state.now >= end) state.now = begin;
    state.playing = true;
    play.textContent = "Pause";
    advance(0);
  }

  const keys = { ArrowRight: () => toCell(1), ArrowLeft: () => toCell(-1), Home: () => go(begin), End: () => go(end), " ": toggle };
  line.addEventListener("keydown", (event) => {
    if (!keys[event.key]) return;
    keys[event.key]();
    if (!state.playing) tell();
    event.preventDefault();
  });
  play.addEventListener("click", toggle);
  scrub.addEventListener("input", () => go(begin + (Number(scrub.value) / 1000) * (end - begin)));
  window.addEventListener("resize", measure);
  dark.addEventListener("change", () => { learnColours(); draw(); });
  find(".moving").hidden = false;
  document.querySelector(".still").hidden = true;
  find(".scale").textContent = "Numbers in the squares are in " + word + "; each lane of voltages is from " + number(least) + " to " + number(most) + " " + word + ".";
  learnColours();
  state.width = line.clientWidth;
  go(reads.length ? reads[0] + 1e-5 : begin);
  return { go };
}
softdotReading(document.getElementById("player"), JSON.parse(document.getElementById("reading-data").textContent));
