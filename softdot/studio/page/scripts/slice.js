// The face in which a plane cuts tetrahedra: triangles whose corners lie on their edges.

// Edges of a tetrahedron around the corners in `above` (bits of corners), in order.
const EDGES = [
  [],
  [
    [0, 1],
    [0, 2],
    [0, 3],
  ],
  [
    [1, 0],
    [1, 3],
    [1, 2],
  ],
  [
    [0, 2],
    [0, 3],
    [1, 3],
    [1, 2],
  ],
  [
    [2, 0],
    [2, 1],
    [2, 3],
  ],
  [
    [0, 1],
    [2, 1],
    [2, 3],
    [0, 3],
  ],
  [
    [1, 0],
    [1, 3],
    [2, 3],
    [2, 0],
  ],
  [
    [3, 0],
    [3, 1],
    [3, 2],
  ],
];
// For each of the 16 ways in which corners lie above: corners at the ends of the edges of its triangles, in a row.
const TRIANGLES = Array.from({ length: 16 }, (_, above) => {
  const edges = EDGES[above < 8 ? above : 15 - above],
    found = [];
  for (let k = 2; k < edges.length; k++) found.push(...edges[0], ...edges[k - 1], ...edges[k]);
  return found;
});

// points: (n, 3) at rest, where the plane at axis = at lies; place (n, 3), paint (n, 4): what is interpolated.
// Of what is cut: place (k, 3), paint (k, 4), part (k), as loose triangles; source (k): a node beside each corner.
export function sliced({ points, tets, region }, place, paint, axis, at, hidden) {
  const ends = cutEdges({ points, tets, region }, axis, at, hidden),
    count = ends.length / 2;
  const cut = {
    place: new Float32Array(3 * count),
    paint: new Uint8Array(4 * count),
    part: new Float32Array(count),
  };
  cut.source = new Uint32Array(count);
  for (let k = 0; k < count; k++) {
    const a = ends[2 * k],
      b = ends[2 * k + 1],
      from = points[3 * a + axis],
      to = points[3 * b + axis];
    const share = (at - from) / (to - from);
    for (let i = 0; i < 3; i++) {
      cut.place[3 * k + i] = place[3 * a + i] + share * (place[3 * b + i] - place[3 * a + i]);
      cut.paint[4 * k + i] = paint[4 * a + i] + share * (paint[4 * b + i] - paint[4 * a + i]);
    }
    cut.part[k] = region[a];
    cut.source[k] = share < 0.5 ? a : b;
  }
  return cut;
}

// Both ends of the edge on which each corner of the cut lies, one after the other.
function cutEdges({ points, tets, region }, axis, at, hidden) {
  const side = new Uint8Array(points.length / 3);
  for (let i = 0; i < side.length; i++) side[i] = points[3 * i + axis] > at ? 1 : 0;
  const shape = new Uint8Array(tets.length / 4);
  let count = 0;
  for (let t = 0, k = 0; t < shape.length; t++, k += 4) {
    const above =
      side[tets[k]] | (side[tets[k + 1]] << 1) | (side[tets[k + 2]] << 2) | (side[tets[k + 3]] << 3);
    if (above === 0 || above === 15 || hidden[region[tets[k]]]) continue;
    shape[t] = above;
    count += TRIANGLES[above].length;
  }
  const ends = new Uint32Array(count);
  for (let t = 0, k = 0; t < shape.length; t++) {
    for (const corner of TRIANGLES[shape[t]]) ends[k++] = tets[4 * t + corner];
  }
  return ends;
}
