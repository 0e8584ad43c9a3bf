// The tab: its socket to the program, and who shows what the program tells.
import * as array from "./array.js";
import { prepareControls } from "./by_hand.js";
import { Curves } from "./curves.js";
import { Designs } from "./designs.js";
import { duration, element, find, roving } from "./dom.js";
import { Form } from "./form.js";
import { filter, hints, tidy } from "./form_search.js";
import { unpacked } from "./frames.js";
import { GoalPanel } from "./goal.js";
import * as next from "./next.js";
import { numbersOf } from "./quantities.js";
import * as recording from "./recording.js";
import { ResponsePanel } from "./response.js";
import * as result from "./result.js";
import { StartPage } from "./start.js";
import { Store } from "./store.js";
import { Editor, prepareTabs } from "./toml.js";

const key = new URLSearchParams(location.search).get("key") || "";
const isCopy = sessionStorage.getItem("open") === "yes"; // a copy of a tab has its storage too
const tab = {
  name: sessionStorage.getItem("tab") || "",
  form: null,
  circuit: null,
  isBuilt: false,
  shown: null,
  painted: {},
  tries: 0,
  viewer: null,
  lacksView: false,
};
const store = new Store(sessionStorage);
const aloud = (text) => {
  find("#heard").textContent = text;
};
const curves = new Curves(find("#curves"), aloud);
const designs = new Designs(ask, (list, runs) => curves.show(list, runs));
const editor = new Editor(find("#text"), find("#toml .lines"));
const start = new StartPage(find("#start"), ask);
const tasks = new next.Tasks(ask, address);
const response = new ResponsePanel(find("#along"), find("#response"), ask, aloud);
const goal = new GoalPanel(find("#goal"), find("#goal-found"), ask);
const RESULTS = { influences: "Each number 10 % larger", tolerances: "Each number at the end of its tolerance" };
// Panels with a mark of their own where they are of a design before.
const PANELS = ["response", "goal"];
const START_MS = 1000;
const MARKED = { numbers: "#numbers", curves: "#curves", circuit: "#circuit .answer", array: "#array figure" };

// Files have addresses of their own, which hold no key; a report is shown in a frame that leads nowhere else.
function address(path) {
  if (path.startsWith("/files/")) return path.endsWith(".html") ? path.replace("/files/", "/show/") : path;
  return `${path}?key=${encodeURIComponent(key)}&tab=${encodeURIComponent(tab.name)}`;
}

function ask(message) {
  if (store.ask(message)) return;
  const isKept = store.unsent.some((one) => one.n === store.number);
  const more = isKept ? "This change is kept in the page and sent when it does." : "This was not done.";
  if (store.link !== "open") say(`softdot studio does not answer. ${more}`, true);
}

function say(text, bad = false) {
  const place = find("#said");
  place.hidden = false;
  place.classList.toggle("good", !bad);
  place.firstElementChild.textContent = text;
}

// Whether something is painted for the first time as it is now.
function isNew(name, now) {
  const before = tab.painted[name];
  tab.painted[name] = now;
  return before !== now;
}

function paintBody() {
  const { state } = store,
    body = store.bodyToShow(tab.shown);
  if (!body || !body.view) return;
  if (tab.viewer && isNew("body", body)) tab.viewer.show(body.view);
  tab.shown = body;
  const isPress = body.tell === "view",
    current = store.isCurrent(body.tell);
  let words = isPress
    ? `The ${body.quality === "array" ? "coarse" : body.quality} press. Move the step, or play it.`
    : "The parts at rest, as they would be made; the press follows when your hand rests.";
  if (!current) words = state.design.mistakes.length ? "The last design without a mistake." : store.before(body.tell);
  find("#view3d .shown").textContent = words;
  find("#view3d canvas").classList.toggle("stale", !current);
}

function paintPress({ said, bad, busy, again, progress }) {
  result.doing(said, busy, bad);
  const bar = find("#press progress");
  find("#press .again").hidden = !again;
  bar.hidden = !busy;
  if (progress && progress.count) bar.value = progress.done / progress.count;
  else bar.removeAttribute("value");
}

function paintForm({ design }) {
  if (!store.form || !design.values) return;
  if (!tab.form) {
    tab.form = new Form(store.form, ask);
    tab.circuit = new Form(store.form, ask);
  }
  tab.form.update(design.values, design.stated, design.mistakes, design.remedies);
  tab.circuit.update(design.values, design.stated, design.mistakes, design.remedies);
  if (!tab.isBuilt) buildForm();
  else tidy(find("#form"));
}

// After the form, and where nobody leaves the start page at once: a driver may take a second to begin.
async function beginView() {
  const module = await import("./view.js").catch(() => null);
  if (!module) {
    tab.lacksView = true;
    say("The 3D view could not be loaded. Reload the page.", true);
    return;
  }
  tab.viewer = new module.View(find("#view3d"));
  paint();
}

function buildForm() {
  tab.isBuilt = true;
  find("#form").replaceChildren(...tab.form.whole());
  filter(find("#form"), find("#find").value); // typed before there was a form
  find("#circuit .fields").replaceChildren(tab.circuit.table(store.form.schema.properties.readout, ["readout"]));
  find("#circuit .fields details").open = true;
  hints(find("#form"), find("#hint"));
  setTimeout(beginView, find("#start").hidden ? 0 : START_MS);
}

function paintDesign({ design }) {
  const text = find("#text");
  if (document.activeElement !== text || !text.dataset.dirty) text.value = design.text;
  if (isNew("lines", design.text + JSON.stringify(design.mistakes))) editor.mark(design.mistakes);
  for (const name of ["undo", "redo", "reset"]) find(`#${name}`).disabled = !design[name];
  const isChecked = design.is_checked || !tab.isBuilt; // before, its form is as the hand has left it
  if (!isChecked || !isNew("check", `${design.of} ${design.is_checked} ${JSON.stringify(late())}`)) return;
  paintForm(store.state);
  array.state(design);
  next.mistakes(design, ask);
  next.warnings(design.mistakes.length ? { warnings: [], remedies: [] } : design, late(), ask);
  next.cost(design);
  const standard = design.values && design.values.dot.standard,
    choice = find("#plate select");
  if (standard && isNew("standard", standard) && choice.options.length) choice.value = standard; // that of the dot
}

// Warnings that only a press tells, of this design.
function late() {
  const { curves: pressed, array: cells } = store.contents;
  if (store.isCurrent("array") && cells) return cells.pressed.warnings.map((text) => ({ text, remedy: null }));
  if (!store.isCurrent("numbers") || !pressed) return [];
  const { warnings = [], remedies = [] } = pressed.curves[pressed.curves.length - 1].numbers;
  return warnings.map((text, i) => ({ text, remedy: remedies[i] }));
}

function paintContents() {
  const { curves: pressed, circuit, array: cells, kept, recording: read, verdict } = store.contents;
  const now = pressed && pressed.curves[pressed.curves.length - 1],
    { estimate } = store.state;
  if (isNew("curves", pressed) && now) designs.present(now);
  const latest = now || { numbers: {}, quality: "" }; // a family estimates before anything is pressed
  const numbers = (now || estimate) && JSON.stringify([estimate, pressed && pressed.revision, latest]);
  if (isNew("numbers", numbers) && numbers) result.show(latest, estimate);
  paintPanels(now, estimate);
  if (isNew("circuit", circuit) && circuit) result.circuit(circuit.found);
  if (isNew("array", cells) && cells) array.show(cells.pressed);
  if (isNew("kept", kept) && kept) designs.hear(kept);
  paintInfluences();
  paintRecording(read, verdict);
}

function paintInfluences() {
  for (const [name, title] of Object.entries(RESULTS)) {
    const found = store.contents[name];
    if (isNew(name, found) && found) {
      next.influences(found.result, title);
      tab.influences = name;
    }
  }
}

function paintRecording(read, verdict) {
  if (isNew("recording", read)) {
    designs.record(read && read.result.of !== "a coupon" ? read.result.runs : []); // a strip is not pressed
    if (read && store.form) recording.show(read.result, ask, store.form.units);
    else find("#recording").replaceChildren();
    tab.painted.verdict = undefined;
  }
  if (isNew("verdict", verdict) && verdict) recording.verdict(verdict.result, ask, address);
}

// What follows one number, and the goal: both are of the numbers that the form shows.
function paintPanels(now, estimate) {
  const { response: along, goal: sought } = store.contents,
    numbers = numbersOf(find("#form"));
  const isOfFamily = store.state.is_of_family;
  if (isNew("offered", JSON.stringify([numbers, isOfFamily]))) {
    response.offer(numbers);
    goal.offer(numbers, isOfFamily);
  }
  if (isNew("response", along) && along) response.show(along.result);
  const isAccurate = store.isCurrent("numbers") && now && now.quality === "accurate",
    isCurrent = store.isCurrent("goal");
  const pressed = isAccurate ? result.atFullLoad(now.numbers) : null;
  if (isNew("goal", JSON.stringify([sought, isCurrent, estimate, pressed])))
    goal.show(sought ? sought.result : null, isCurrent, estimate, pressed);
}

// Long work: each as far as the program says it is.
function paintTasks({ tasks: known, artefacts }) {
  for (const [task, { is, progress, said, took_s: took }] of Object.entries(known)) {
    const name = task === "diagnosis" ? "verdict" : task,
      made = store.contents[name];
    if (isNew(`result of ${task}`, made) && made) tasks.done({ task, result: made.result });
    if (isNew(`state of ${task}`, JSON.stringify(known[task]))) {
      if (is === "running") tasks.progress({ task, ...progress });
      else tasks.ended({ task, said: is === "done" ? `done in ${duration(took)}` : said, bad: is === "failed" });
    }
    const isOld = Boolean(artefacts[name]) && !artefacts[name].current;
    tasks.item(task).querySelector(".old").hidden = PANELS.includes(name) || !isOld;
  }
}

// What belongs to another design is marked, and one click makes it anew.
function paintMarks({ artefacts }) {
  const isOld = (name) => Boolean(artefacts[name] && !artefacts[name].current);
  find("#before").hidden = !isOld("numbers");
  const other = `a design before: ${artefacts.numbers ? artefacts.numbers.what : ""}`;
  const whose = `those of ${store.state.design.mistakes.length ? "the last design without a mistake" : other}.`;
  find("#before").textContent = store.state.estimate
    ? `Force, charge and voltage are estimated; curves and other numbers are ${whose}`
    : `The numbers and curves are still ${whose}`;
  for (const [name, place] of Object.entries(MARKED)) find(place).classList.toggle("stale", isOld(name));
  markPanel("#influences", tab.influences, () => ask({ do: "start", task: tab.influences }));
  markPanel("#response", "response", () => response.again());
}

// A panel of a design before says so, with a button that makes it anew.
function markPanel(panel, name, again) {
  const place = find(panel),
    old = name ? store.before(name) : "";
  place.classList.toggle("stale", Boolean(old));
  if (!isNew(`mark of ${panel}`, old) && Boolean(place.querySelector(".before")) === Boolean(old)) return;
  for (const mark of place.querySelectorAll(".before")) mark.remove();
  if (!old) return;
  const button = element("button", { type: "button", onclick: again }, "Make it anew");
  place.prepend(element("p", { class: "before" }, `${old} `, button));
}

function paintLink() {
  const { state, link } = store;
  const kept = store.unsent.length
    ? "your last change is kept in this page and is sent when it answers"
    : "nothing can be changed until it does";
  const words = {
    starting: "starting…",
    open: state && state.saved !== true ? state.saved : "on this machine only; every change is saved",
    lost: `softdot studio does not answer; ${kept}`,
    ended: `softdot studio has ended; ${kept}. Start it again, and this page goes on.`,
    elsewhere: "this design is open in another tab, where it goes on",
  };
  find("#link").textContent = words[link] + (link === "open" && state && state.machine ? ` – ${state.machine}` : "");
  find("#link").classList.toggle(
    "bad",
    (link !== "open" && link !== "starting") || Boolean(state && state.saved !== true),
  );
  find("#design").inert = ["lost", "ended", "elsewhere"].includes(link);
}

function paint() {
  paintLink();
  if (!store.state) return;
  paintDesign(store.state);
  paintContents();
  paintTasks(store.state);
  paintBody();
  paintPress(store.state);
  paintMarks(store.state);
  start.meets(store.state.design);
}

function hear(told) {
  store.hear(told);
  if (told.tell === "tab") {
    tab.name = told.name;
    sessionStorage.setItem("tab", told.name);
  } else if (told.tell === "elsewhere") store.link = "elsewhere";
  else if (told.tell === "said") say(told.text, told.bad);
  else if (told.tell === "form") {
    find("#plate select").replaceChildren(
      ...told.standards.map((one) => element("option", { value: one.name }, one.name)),
    );
    tab.painted.check = undefined;
    start.hearForm(told);
  } else if (told.tell === "earlier") start.hearEarlier(told.designs);
  if (["state", "form", "elsewhere"].includes(told.tell)) paint();
}

// The address of the socket. Where this tab comes back, another program may listen on the port by now: the program
// shows that it holds the key, and so does the tab, and neither sends it. A page that is not local has no way to do so.
async function socketAddress() {
  const own = address("/socket") + (isCopy && !tab.hasOpened ? "&copy=1" : "");
  if (!tab.hasOpened || !window.crypto.subtle) return own;
  const bytes = (text) => new TextEncoder().encode(text),
    hex = (found) => [...new Uint8Array(found)].map((one) => one.toString(16).padStart(2, "0")).join("");
  const secret = await crypto.subtle.importKey("raw", bytes(key), { name: "HMAC", hash: "SHA-256" }, false, ["sign"]);
  const proof = async (text) => hex(await crypto.subtle.sign("HMAC", secret, bytes(text)));
  const nonce = hex(crypto.getRandomValues(new Uint8Array(16)));
  const greeting = await (await fetch(`/greeting?nonce=${nonce}`)).json();
  if (greeting.proof !== (await proof(`studio:${nonce}`))) throw new Error("another program answers");
  const answer = await proof(`tab:${greeting.question}`);
  return `/socket?tab=${encodeURIComponent(tab.name)}&question=${greeting.question}&proof=${answer}`;
}

function lost() {
  if (store.link === "elsewhere") return;
  tab.tries += 1;
  store.closed(tab.tries >= 30);
  paintLink();
  setTimeout(connect, Math.min(500 * tab.tries, 5000));
}

async function connect() {
  let socket;
  try {
    socket = new WebSocket(`ws://${location.host}${await socketAddress()}`);
  } catch {
    lost();
    return;
  }
  socket.binaryType = "arraybuffer";
  socket.addEventListener("open", () => {
    if (tab.lacksView) location.reload(); // a browser may remember that a script did not come
    Object.assign(tab, { tries: 0, hasOpened: true });
    sessionStorage.setItem("open", "yes");
    store.opened((text) => socket.send(text));
    paintLink();
  });
  socket.addEventListener("message", (event) => {
    const told = unpacked(event.data);
    hear(told);
    document.dispatchEvent(new CustomEvent("softdot", { detail: told.tell }));
  });
  socket.addEventListener("close", lost);
}

window.addEventListener("pagehide", () => sessionStorage.removeItem("open"));

window.addEventListener("dragover", (event) => event.preventDefault());
window.addEventListener("drop", (event) => event.preventDefault());
prepareTabs();
roving(find("header .tools"));
prepareControls({ store, ask, say, start });
find("#form").addEventListener("input", ({ target }) => {
  const field = target.closest(".field[data-key]");
  if (field) response.follow(field.dataset.key);
});
recording.prepare(address, say);
array.prepare(ask);
connect();
