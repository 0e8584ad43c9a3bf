// Messages of the program: JSON, or a binary frame whose arrays are looked at where they lie
// (softdot/studio/frames.py).
const KINDS = { float32: Float32Array, int16: Int16Array, uint8: Uint8Array, uint32: Uint32Array };
const ALIGNED = 8;

export function unpacked(content) {
  if (typeof content === "string") return JSON.parse(content);
  const length = new DataView(content).getUint32(0, true);
  const start = Math.ceil((4 + length) / ALIGNED) * ALIGNED;
  const text = new TextDecoder().decode(new Uint8Array(content, 4, length));
  return JSON.parse(text, (_, value) =>
    value && value.array ? new KINDS[value.array](content, start + value.at, value.count) : value,
  );
}
