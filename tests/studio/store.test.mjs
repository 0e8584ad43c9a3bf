// The store of the page, without a page: node --test tests/studio/store.test.mjs
import assert from "node:assert/strict";
import { test } from "node:test";

import { unpacked } from "../../softdot/studio/page/scripts/frames.js";
import { numberOf, quantity } from "../../softdot/studio/page/scripts/numbers.js";
import { Store } from "../../softdot/studio/page/scripts/store.js";

function storage() {
  const kept = new Map();
  return { getItem: (name) => kept.get(name) ?? null, setItem: (name, value) => kept.set(name, value) };
}

const state = (heard, artefacts = {}) => ({ tell: "state", heard, artefacts, design: { text: "" } });

test("a change is sent once and kept until it is heard", () => {
  const sent = [],
    store = new Store(storage());
  store.opened((text) => sent.push(JSON.parse(text)));
  store.hear(state(0));
  assert.equal(store.ask({ do: "set", key: ["a"], value: 1 }), true);
  assert.equal(store.unsent.length, 1);
  store.hear(state(1));
  assert.deepEqual(store.unsent, []);
  assert.deepEqual(sent, [{ do: "set", key: ["a"], value: 1, n: 1 }]);
});

test("what was changed without the program is sent when it answers, also after the page was loaded again", () => {
  const kept = storage(),
    first = new Store(kept),
    sent = [];
  first.opened(() => {});
  first.hear(state(0));
  first.closed(false);
  for (const value of [1, 2, 3]) assert.equal(first.ask({ do: "set", key: ["a"], value }), false);
  assert.equal(first.ask({ do: "undo" }), false);
  const again = new Store(kept);
  again.opened((text) => sent.push(JSON.parse(text)));
  assert.deepEqual(sent, []); // not before the program has told what it heard
  again.hear(state(0));
  assert.deepEqual(
    sent.map(({ do: what, value }) => [what, value]),
    [["set", 3]],
  );
  again.hear(state(4));
  assert.equal(again.unsent.length, 0);
});

test("what is not current says of which design it is, and is not shown as that of this one", () => {
  const store = new Store(storage());
  const view = { tell: "view", revision: 1, view: { steps: [] } },
    parts = { tell: "parts", revision: 2, view: {} };
  store.hear(view);
  store.hear(parts);
  store.hear(state(0, { view: { current: false, what: "depth = 1" }, parts: { current: true, what: "this design" } }));
  assert.equal(store.before("view"), "Of a design before: depth = 1.");
  assert.equal(store.before("parts"), "");
  assert.equal(store.bodyToShow(view), parts);
  store.hear(state(0, { view: { current: true, what: "" }, parts: { current: true, what: "" } }));
  assert.equal(store.bodyToShow(parts), view);
  store.hear(state(0, {}));
  assert.equal(store.contents.view, undefined);
});

test("a frame is unpacked into arrays that lie in it", () => {
  const view = { points: { array: "float32", at: 0, count: 2 }, region: { array: "uint8", at: 8, count: 3 }, plane: 1 };
  const head = new TextEncoder().encode(JSON.stringify({ tell: "parts", view }).padEnd(148));
  const frame = new Uint8Array(4 + head.length + 16);
  new DataView(frame.buffer).setUint32(0, head.length, true);
  frame.set(head, 4);
  frame.set(new Uint8Array(Float32Array.of(0.5, -2).buffer), 152);
  frame.set([7, 8, 9], 160);
  const told = unpacked(frame.buffer);
  assert.deepEqual([...told.view.points], [0.5, -2]);
  assert.deepEqual([...told.view.region], [7, 8, 9]);
  assert.equal(told.view.plane, 1);
  assert.deepEqual(unpacked('{"tell": "said"}'), { tell: "said" });
});

test("numbers are shown with what is known of them", () => {
  const plain = (...of) => quantity(...of).replace(/[\u2009\u00a0]/g, " ");
  assert.equal(plain(62.4, "V", 16.2), "62 ± 16 V");
  assert.equal(plain(0.00823, "V", null, 2), "8.2 mV");
  assert.equal(plain(0.4931, "N", 0.0898), "0.493 ± 0.090 N");
  assert.equal(plain(229.4, "pC", 91.2), "229 ± 91 pC");
  assert.equal(plain(2294, "pC", 912), "2.29 ± 0.91 nC");
  assert.equal(plain(12345, "V", 1234), "12.3 ± 1.2 kV");
  assert.equal(plain(-0.2, "V"), "−0.200 V");
  assert.equal(plain(0, "N", 0.02), "0 ± 20 mN");
  assert.equal(plain(1, "N", 3), "1.0 ± 3.0 N");
  assert.equal(plain(null, "V"), "–");
});

test("numbers are read as people type them", () => {
  const typed = {
    "0,5": 0.5,
    0.5: 0.5,
    " 12 ": 12,
    "1e-9": 1e-9,
    "\u22123": -3,
    "": null,
    "1,000.5": "1,000.5",
    abc: "abc",
  };
  for (const [text, value] of Object.entries(typed)) assert.equal(numberOf(text), value);
});
