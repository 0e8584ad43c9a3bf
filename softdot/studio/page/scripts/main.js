// The tab: its socket to the program, and who shows what the program tells.
import * as array from "./array.js";
import { element, find } from "./dom.js";
import { Form, filter } from "./form.js";
import * as next from "./next.js";
import * as recording from "./recording.js";
import * as result from "./result.js";

const key = new URLSearchParams(location.search).get("key") || "";
const state = { tab: sessionStorage.getItem("tab") || "", form: null, circuit: null, quality: null, late: [], design: null, socket: null, tries: 0 };
const address = (path) => `${path}?key=${encodeURIComponent(key)}&tab=${encodeURIComponent(state.tab)}`;
const viewer = softdotViewer(find("#view3d"));
const tasks = new next.Tasks(ask, address);

function ask(message) {
  if (state.socket && state.socket.readyState === WebSocket.OPEN) state.socket.send(JSON.stringify(message));
  else say("The program does not answer: is softdot studio still running? The design is kept.", true);
}

function say(text, bad = false) {
  const place = find("#said");
  place.hidden = false;
  place.classList.toggle("good", !bad);
  place.firstElementChild.textContent = text;
}

function shown(view, words) {
  viewer.show(view);
  find("#view3d .shown").textContent = words;
  find("#view3d .play").disabled = view.steps.length < 2;
}

// Where there is nothing to press, why: it counts more than that the press before was cancelled.
function nothingToPress() {
  const { mistakes = [], array: cells, press_hash: hash } = state.design || {};
  if (mistakes.length) result.doing("The design has a mistake; mend it and it is pressed.", false, true);
  else if (state.ofArray && cells && !hash) result.doing("Raise a dot of the cell to press it.", false);
  else return;
  find("#press .again").hidden = true;
  if (mistakes.length && find("#view3d .step-text").textContent) find("#view3d .shown").textContent = "The last design without a mistake.";
}

// Whether the numbers are those of another design than the one in the form.
function stale() {
  const old = Boolean(state.shownHash) && !state.ofArray && state.design && state.design.press_hash !== state.shownHash;
  find("#before").hidden = !old;
  for (const place of ["#numbers", "#curves"]) find(place).classList.toggle("stale", old);
}

const hear = {
  tab({ name }) {
    state.tab = name;
    sessionStorage.setItem("tab", name);
  },
  form(about) {
    state.form = new Form(about, ask);
    state.circuit = new Form(about, ask);
    find("#plate select").replaceChildren(...about.standards.map((one) => element("option", { value: one.name }, one.name)));
    find("#plate select").value = "marburg-medium";
  },
  document(told) {
    const text = find("#text");
    if (document.activeElement !== text || !text.dataset.dirty) text.value = told.text;
    state.text = told.text;
    tasks.follow(told.text);
    for (const name of ["undo", "redo", "reset"]) find(`#${name}`).disabled = !told[name];
  },
  parts({ view }) {
    shown(view, "The parts at rest, as they would be made; the press follows when your hand rests.");
  },
  state(told) {
    state.design = told;
    if (told.values) {
      const first = !state.built;
      state.built = true;
      state.form.update(told.values, told.stated, told.mistakes);
      state.circuit.update(told.values, told.stated, told.mistakes);
      if (first) {
        find("#form").replaceChildren(...state.form.whole());
        filter(find("#form"), find("#find").value); // typed before there was a form
        find("#circuit .fields").replaceChildren(state.circuit.table(state.form.about.schema.properties.readout, ["readout"]));
        find("#circuit .fields details").open = true;
      }
    }
    state.ofArray = array.state(told);
    nothingToPress();
    stale();
    next.mistakes(told, ask);
    next.warnings(told.mistakes.length ? { warnings: [], remedies: [] } : told, state.late, ask);
    next.cost(told);
  },
  curves({ curves }) {
    const now = curves[curves.length - 1];
    state.quality = now.quality;
    state.late = (now.numbers.warnings || []).map((text, i) => ({ text, remedy: (now.numbers.remedies || [])[i] }));
    result.show(curves);
    state.shownHash = now.press_hash;
    stale();
    if (state.design) next.warnings(state.design, state.late, ask);
  },
  array({ pressed }) {
    state.quality = "coarse";
    state.late = pressed.warnings.map((text) => ({ text, remedy: null }));
    array.show(pressed);
    if (state.design) next.warnings(state.design, state.late, ask);
  },
  pressed({ view }) {
    shown(view, `The ${state.quality} press. Move the step, or play it.`);
  },
  circuit({ found }) {
    result.circuit(found);
  },
  progress(told) {
    if (told.task === "press") result.progress(told);
    else tasks.progress(told);
  },
  ended(told) {
    if (told.task !== "press") return tasks.ended(told);
    result.ended(told, state);
    return nothingToPress();
  },
  done(told) {
    tasks.done(told);
    if (told.task === "influences") next.influences(told.result, "Each number 10 % larger");
    if (told.task === "tolerances") next.influences(told.result, "Each number at the end of its tolerance");
    if (told.task === "recording") recording.show(told.result, ask, state.form.about.units);
    if (told.task === "diagnosis") recording.verdict(told.result, ask, address);
  },
  kept(told) {
    next.kept(told, ask);
  },
  earlier({ designs }) {
    const time = (one) => new Date(1000 * one.saved_s).toLocaleString();
    find(".earlier").hidden = !designs.length;
    find("#earlier").replaceChildren(element("option", { value: "" }, "choose…"), ...designs.map((one) => element("option", { value: one.name }, `${time(one)}: ${one.lines}`)));
  },
  said({ text, bad }) {
    say(text, bad);
  },
};

function connect() {
  const socket = new WebSocket(`ws://${location.host}${address("/socket")}`);
  state.socket = socket;
  socket.addEventListener("open", () => { state.tries = 0; find("#link").textContent = "on this machine only; every change is kept"; });
  socket.addEventListener("message", (event) => {
    const told = JSON.parse(event.data);
    hear[told.tell](told);
    document.dispatchEvent(new CustomEvent("softdot", { detail: told.tell }));
  });
  socket.addEventListener("close", () => {
    find("#link").textContent = "no answer; trying again…";
    state.tries += 1;
    if (state.tries < 30) setTimeout(connect, Math.min(500 * state.tries, 5000));
    else find("#link").textContent = "softdot studio has ended; the design is kept";
  });
}

function typing() {
  const text = find("#text");
  let later = null;
  const send = () => { delete text.dataset.dirty; if (text.value !== state.text) ask({ do: "text", text: text.value }); };
  text.addEventListener("input", () => { text.dataset.dirty = "yes"; clearTimeout(later); later = setTimeout(send, 500); });
  text.addEventListener("change", send);
}

function files() {
  const input = find("#import-file");
  const open = async (file) => {
    if (file.size > 200000) return say(`'${file.name}' has ${(file.size / 1e6).toFixed(1)} MB: a design is a small TOML file.`, true);
    return ask({ do: "text", text: await file.text() });
  };
  find("#import").addEventListener("click", () => input.click());
  input.addEventListener("change", () => { if (input.files[0]) open(input.files[0]); input.value = ""; });
  find("#export").addEventListener("click", () => {
    const made = URL.createObjectURL(new Blob([state.text], { type: "application/toml" }));
    element("a", { href: made, download: "design.toml" }).click();
    setTimeout(() => URL.revokeObjectURL(made), 1000);
  });
  const design = find("#design");
  design.addEventListener("dragover", (event) => event.preventDefault());
  design.addEventListener("drop", (event) => { event.preventDefault(); if (event.dataTransfer.files[0]) open(event.dataTransfer.files[0]); });
}

function buttons() {
  for (const name of ["undo", "redo", "reset"]) find(`#${name}`).addEventListener("click", () => ask({ do: name }));
  document.addEventListener("keydown", (event) => {
    if (!(event.ctrlKey || event.metaKey) || event.target.matches("textarea, input[type=text], input[type=search], input[type=number]")) return;
    const name = event.key === "z" ? (event.shiftKey ? "redo" : "undo") : event.key === "y" ? "redo" : null;
    if (name) { event.preventDefault(); ask({ do: name }); }
  });
  find("#press .cancel").addEventListener("click", () => ask({ do: "cancel", task: "press" }));
  find("#press .again").addEventListener("click", () => { find("#press .again").hidden = true; ask({ do: "press" }); });
  for (const one of document.querySelectorAll("[data-start]")) one.addEventListener("click", () => ask({ do: "start", task: one.dataset.start }));
  find("#plate button").addEventListener("click", () => ask({ do: "start", task: "plate", kind: "text", text: find("#plate input").value, standard: find("#plate select").value }));
  find("#keep").addEventListener("submit", (event) => { event.preventDefault(); ask({ do: "keep", name: find("#keep input").value }); find("#keep input").value = ""; });
  find("#earlier").addEventListener("change", (event) => { if (event.target.value) ask({ do: "restore", name: event.target.value }); event.target.value = ""; });
  find("#said button").addEventListener("click", () => { find("#said").hidden = true; });
  find("#find").addEventListener("input", (event) => filter(find("#form"), event.target.value));
  find("#form").addEventListener("submit", (event) => event.preventDefault());
}

window.addEventListener("dragover", (event) => event.preventDefault());
window.addEventListener("drop", (event) => event.preventDefault());
typing();
files();
buttons();
recording.prepare(address, say);
array.prepare(ask);
connect();
