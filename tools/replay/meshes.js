// Converts the page's data to triangles for the graphics processor: grids get two triangles per cell, and shared
// corners a common normal.
function meshOf(said, vertices, corners) {
  const scale = said.scale_m;
  let vertexCount = 0, cornerCount = 0;
  for (const part of said.parts) {
    vertexCount += part.vertices;
    cornerCount += part.rows ? 6 * (part.rows - 1) * (part.columns - 1) : part.corners;
  }
  const positions = new Float32Array(3 * vertexCount), normals = new Float32Array(3 * vertexCount);
  const colours = new Uint8Array(4 * vertexCount), indices = new Uint32Array(cornerCount);
  for (let i = 0; i < 3 * vertexCount; ++i) positions[i] = vertices[i] * scale;
  const ranges = [];
  let firstVertex = 0, firstCorner = 0, at = 0;
  for (const part of said.parts) {
    const begin = at;
    if (part.rows) at = gridTriangles(part, firstVertex, indices, at);
    else for (let k = 0; k < part.corners; ++k) indices[at++] = firstVertex + corners[firstCorner + k];
    for (let v = firstVertex; v < firstVertex + part.vertices; ++v)
      for (let c = 0; c < 4; ++c) colours[4 * v + c] = Math.round(255 * part.rgba[c]);
    ranges.push({ begin, count: at - begin, ground: Boolean(part.rows), clear: part.rgba[3] < 1 });
    firstVertex += part.vertices;
    firstCorner += part.corners;
  }
  sumNormals(positions, indices, normals);
  return { positions, normals, colours, indices, ranges };
}

function gridTriangles(part, first, indices, at) {
  for (let row = 0; row + 1 < part.rows; ++row) {
    for (let column = 0; column + 1 < part.columns; ++column) {
      const here = first + row * part.columns + column, up = here + part.columns;
      for (const corner of [here, here + 1, up + 1, here, up + 1, up]) indices[at++] = corner;
    }
  }
  return at;
}

// The normal of a corner is the area-weighted mean of the normals of its triangles.
function sumNormals(positions, indices, normals) {
  for (let i = 0; i + 2 < indices.length; i += 3) {
    const [a, b, c] = [3 * indices[i], 3 * indices[i + 1], 3 * indices[i + 2]];
    const ux = positions[b] - positions[a], uy = positions[b + 1] - positions[a + 1], uz = positions[b + 2] - positions[a + 2];
    const vx = positions[c] - positions[a], vy = positions[c + 1] - positions[a + 1], vz = positions[c + 2] - positions[a + 2];
    const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
    for (const corner of [a, b, c]) {
      normals[corner] += x;
      normals[corner + 1] += y;
      normals[corner + 2] += z;
    }
  }
  for (let i = 0; i < normals.length; i += 3) {
    const length = Math.hypot(normals[i], normals[i + 1], normals[i + 2]) || 1;
    for (let k = 0; k < 3; ++k) normals[i + k] /= length;
  }
}

// A level ground with grid lines, used if there is no world.
function emptyGround(z, half) {
  const rgba = [0.42, 0.45, 0.47, 1];
  const said = { scale_m: 1, parts: [{ rows: 2, columns: 2, vertices: 4, corners: 0, rgba }] };
  return meshOf(said, [-half, -half, z, half, -half, z, -half, half, z, half, half, z], []);
}
