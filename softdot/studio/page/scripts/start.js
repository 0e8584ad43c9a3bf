// The start page: what this sensor is, designs to begin with, and those of before.
import { element, find } from "./dom.js";
import { labelled, sketch } from "./sketch.js";

const WHAT = [
  "A soft block holds a piezoelectric film between two elastic media. A raised Braille dot presses into the block " +
    "from above, the media bend the film, and the strained film frees a charge: a voltage that tells where a dot is.",
  "Here you change such a sensor by hand, see its parts at once, and get force, charge and voltage of a press some " +
    "seconds later, as softdot run calculates them, with how far each can be trusted.",
];
const DOCUMENTS = "docs/studio.md of softdot explains this page, docs/tutorial.md is a tour of ten minutes.";
const RECORDING =
  "A folder of recorded presses of a real sensor: compare it with this design, and learn what the design left out.";

export class StartPage {
  // ask(message): tells the program.
  constructor(place, ask) {
    this.place = place;
    this.ask = ask;
    this.earlier = [];
    this.form = null;
    this.told = false;
    place.addEventListener("keydown", (event) => {
      if (event.key === "Escape") this.close();
    });
  }

  hearForm(form) {
    this.form = form;
    this.draw();
  }

  hearEarlier(designs) {
    this.earlier = designs;
    this.draw();
  }

  // A tab that is new and has the default design begins here.
  meets(design) {
    if (this.told || !this.form) return;
    this.told = true;
    const fresh = !sessionStorage.getItem("begun") && design.text === this.form.starts[0].text;
    if (fresh) this.open();
    sessionStorage.setItem("begun", "yes");
  }

  open() {
    this.place.hidden = false;
    for (const other of ["main", "nav"]) find(other).hidden = true;
    this.draw();
    const go = this.place.querySelector(".go");
    if (go) go.focus();
  }

  close() {
    this.place.hidden = true;
    for (const other of ["main", "nav"]) find(other).hidden = false;
    window.dispatchEvent(new Event("resize"));
  }

  take(message) {
    this.ask(message);
    this.close();
  }

  draw() {
    if (this.place.hidden || !this.form) return;
    const text = element("div", {}, ...WHAT.map((one) => element("p", {}, one)), this.way());
    this.place.replaceChildren(
      element("h2", { id: "start-title" }, "A soft sensor that reads one Braille dot"),
      element("div", { class: "what" }, text, labelled()),
      element("h3", {}, "Begin with"),
      element("ul", { class: "cards" }, ...this.form.starts.map((one) => this.card(one)), this.recording()),
      ...this.before(),
    );
  }

  way() {
    const go = element(
      "button",
      { type: "button", class: "go", onclick: () => this.close() },
      "Go on with the design of this tab",
    );
    return element("p", {}, go, element("br"), element("span", { class: "soft" }, DOCUMENTS));
  }

  card({ title, about, text, sizes }) {
    const begin = element("button", { type: "button", onclick: () => this.take({ do: "text", text }) });
    begin.append(sketch(sizes), element("strong", {}, title), about);
    return element("li", {}, begin);
  }

  recording() {
    const begin = element("button", { type: "button" }, element("strong", {}, "From a recording"), RECORDING);
    begin.addEventListener("click", () => {
      this.close();
      find("#drop").scrollIntoView({ block: "center" });
      find("#drop .folder").focus();
    });
    return element("li", {}, begin);
  }

  before() {
    if (!this.earlier.length) return [];
    const time = (one) => new Date(1000 * one.saved_s).toLocaleString();
    const cards = this.earlier.map((one) => {
      const begin = element("button", {
        type: "button",
        onclick: () => this.take({ do: "restore", name: one.name }),
      });
      begin.append(sketch(one.sizes), element("strong", {}, one.title || "Without a name"), time(one));
      return element("li", {}, begin);
    });
    return [element("h3", {}, "Earlier designs"), element("ul", { class: "cards", id: "earlier" }, ...cards)];
  }
}
