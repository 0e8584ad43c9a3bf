// What is asked of the program by hand: the text of a design, files, buttons, keys.
import { element, find, findAll } from "./dom.js";
import { filter, tidy } from "./form_search.js";

// The design as text: a change counts when the hand pauses.
function typing({ store, ask }) {
  const text = find("#text");
  let later = null;
  const send = () => {
    delete text.dataset.dirty;
    if (store.state && text.value !== store.state.design.text) ask({ do: "text", text: text.value });
  };
  text.addEventListener("input", () => {
    text.dataset.dirty = "yes";
    clearTimeout(later);
    later = setTimeout(send, 500);
  });
  text.addEventListener("change", send);
}

function files({ store, ask, say }) {
  const input = find("#import-file");
  const open = async (file) => {
    if (file.size > 200000)
      return say(`'${file.name}' has ${(file.size / 1e6).toFixed(1)} MB: a design is a small TOML file.`, true);
    return ask({ do: "text", text: await file.text() });
  };
  find("#import").addEventListener("click", () => input.click());
  input.addEventListener("change", () => {
    if (input.files[0]) open(input.files[0]);
    input.value = "";
  });
  find("#export").addEventListener("click", () => {
    const made = URL.createObjectURL(
      new Blob([store.state ? store.state.design.text : ""], { type: "application/toml" }),
    );
    element("a", { href: made, download: "design.toml" }).click();
    setTimeout(() => URL.revokeObjectURL(made), 1000);
  });
  const design = find("#design");
  design.addEventListener("dragover", (event) => event.preventDefault());
  design.addEventListener("drop", (event) => {
    event.preventDefault();
    if (event.dataTransfer.files[0]) open(event.dataTransfer.files[0]);
  });
}

function buttons({ ask, start }) {
  for (const name of ["undo", "redo", "reset"]) find(`#${name}`).addEventListener("click", () => ask({ do: name }));
  // What is being typed has an undo of its own; once it is sent, undo is that of the design.
  const typed = new WeakSet();
  document.addEventListener("input", (event) => typed.add(event.target), true);
  document.addEventListener("change", (event) => typed.delete(event.target), true);
  document.addEventListener("keydown", (event) => {
    const at = /** @type {Element} */ (event.target);
    if (!(event.ctrlKey || event.metaKey) || typed.has(at) || at.matches("textarea")) return;
    const name =
      event.key.toLowerCase() === "z" ? (event.shiftKey ? "redo" : "undo") : event.key === "y" ? "redo" : null;
    if (name) {
      event.preventDefault();
      ask({ do: name });
    }
  });
  find("#press .cancel").addEventListener("click", () => ask({ do: "cancel", task: "press" }));
  find("#press .again").addEventListener("click", () => {
    ask({ do: "press" });
  });
  for (const one of findAll("[data-start]"))
    one.addEventListener("click", () => ask({ do: "start", task: one.dataset.start }));
  find("#plate button").addEventListener("click", () =>
    ask({
      do: "start",
      task: "plate",
      kind: "text",
      text: find("#plate input").value,
      standard: find("#plate select").value,
    }),
  );
  find("#keep").addEventListener("submit", (event) => {
    event.preventDefault();
    ask({ do: "keep", name: find("#keep input").value });
    find("#keep input").value = "";
  });
  find("#every").addEventListener("change", (event) => {
    find("#form").classList.toggle("every", event.target.checked);
    tidy(find("#form"));
  });
  find("#begin").addEventListener("click", () => start.open());
  find("#said button").addEventListener("click", () => {
    find("#said").hidden = true;
  });
  find("#find").addEventListener("input", (event) => filter(find("#form"), event.target.value));
  find("#form").addEventListener("submit", (event) => event.preventDefault());
}

// tab: store, ask(message), say(text, bad), start (the start page).
export function prepareControls(tab) {
  typing(tab);
  files(tab);
  buttons(tab);
}
