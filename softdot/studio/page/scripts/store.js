// What the program has told: one place that every panel reads. It knows no page, so that it can be tested without one.
//
// state: the last message {"tell": "state"}, whole: phase, sentence, design, artefacts, tasks, kept (docs/studio.md).
// contents: the last message of each artefact (curves, view, parts, circuit, array, kept, influences, kit, ...), each
// with the revision of its design; whether it is of the present design is said by state.artefacts[name].current alone.
// link: "starting", "open", "lost" or "ended".

const CHANGES = new Set(["set", "change", "text"]);
const same = (one, other) =>
  one.do === "set" && other.do === "set" && JSON.stringify(one.key) === JSON.stringify(other.key);

export class Store {
  // storage: as sessionStorage; what is not sent yet is kept there and outlives a reload.
  constructor(storage) {
    this.storage = storage;
    this.state = null;
    this.contents = {};
    this.form = null;
    this.link = "starting";
    this.listeners = new Set();
    this.unsent = JSON.parse(storage.getItem("unsent") || "[]");
    this.number = Number(storage.getItem("number") || 0);
    this.send = null;
    this.isFresh = true;
  }

  // Calls back after every change, with the kind of what was told.
  subscribe(listener) {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  tell(kind) {
    for (const listener of this.listeners) listener(kind);
  }

  // send(text): to the program.
  opened(send) {
    this.send = send;
    this.isFresh = true;
    this.link = "open";
    this.tell("link");
  }

  closed(isOver) {
    this.send = null;
    this.link = isOver ? "ended" : "lost";
    this.tell("link");
  }

  // One message of the program.
  hear(told) {
    if (told.tell === "state") this.hearState(told);
    else if (told.tell === "form") this.form = told;
    else if (!["said", "tab", "elsewhere"].includes(told.tell)) this.contents[told.tell] = told;
    this.tell(told.tell);
  }

  hearState(told) {
    this.state = told;
    for (const name of Object.keys(this.contents)) {
      if (!(name in told.artefacts) && !["kept", "earlier"].includes(name)) delete this.contents[name];
    }
    this.keep(this.unsent.filter((one) => one.n > told.heard));
    if (this.isFresh) for (const one of this.unsent) this.send(JSON.stringify(one));
    this.isFresh = false;
  }

  // Asks the program for something. Returns whether it was sent; a change of the design is kept until it is heard.
  ask(message) {
    this.number += 1;
    const numbered = { ...message, n: this.number };
    this.storage.setItem("number", String(this.number));
    if (CHANGES.has(message.do)) {
      const last = this.unsent[this.unsent.length - 1];
      this.keep([...(last && !this.send && same(last, message) ? this.unsent.slice(0, -1) : this.unsent), numbered]);
    }
    if (!this.send || this.isFresh) return false;
    this.send(JSON.stringify(numbered));
    return true;
  }

  keep(unsent) {
    this.unsent = unsent;
    this.storage.setItem("unsent", JSON.stringify(unsent));
  }

  // Whether an artefact is there and of the present design.
  isCurrent(name) {
    const made = this.state && this.state.artefacts[name];
    return Boolean(made && made.current);
  }

  // Of which design an artefact is, where it is of another one; empty otherwise.
  before(name) {
    const made = this.state && this.state.artefacts[name];
    return made && !made.current ? `Of a design before: ${made.what}.` : "";
  }

  // What the 3D view shows: the press of this design, else its parts, else what was shown last.
  bodyToShow(shown) {
    if (this.isCurrent("view") && this.contents.view && this.contents.view.view) return this.contents.view;
    if (this.isCurrent("parts") && this.contents.parts) return this.contents.parts;
    return shown || this.contents.parts || this.contents.view || null;
  }
}
