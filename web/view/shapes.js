"use strict";
// Shapes as the program packs them → geometry: what stands still in cells that are drawn or left out as a whole, and one
// body for everyone who moves.
const shapes = (() => {
  const CELL_M = 40;
  const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));

  function unpacked({ from, size, positions, colors, triangles, vertices }) {
    const steps = new Uint16Array(bytes(positions).buffer);
    const at = Float32Array.from(steps, (step, i) => from[i % 3] + (size[i % 3] * step) / 65535);
    const index = bytes(triangles).buffer;
    return {
      positions: at,
      colors: bytes(colors),
      triangles: vertices <= 65536 ? new Uint16Array(index) : new Uint32Array(index),
    };
  }

  /** Meshes at their places as one geometry. */
  function joined(T, meshes, placed) {
    let [vertices, corners] = [0, 0];
    for (const { mesh } of placed) {
      vertices += meshes[mesh].positions.length;
      corners += meshes[mesh].triangles.length;
    }
    const [positions, colors, index] = [new Float32Array(vertices), new Uint8Array(vertices), new Uint32Array(corners)];
    let [v, c] = [0, 0];
    for (const { mesh, pose: m } of placed) {
      const { positions: p, colors: of, triangles } = meshes[mesh];
      for (let i = 0; i < p.length; i += 3) {
        const [x, y, z] = [p[i], p[i + 1], p[i + 2]];
        positions[v + i] = m[0] * x + m[1] * y + m[2] * z + m[3];
        positions[v + i + 1] = m[4] * x + m[5] * y + m[6] * z + m[7];
        positions[v + i + 2] = m[8] * x + m[9] * y + m[10] * z + m[11];
      }
      colors.set(of, v);
      for (let i = 0; i < triangles.length; i++) index[c + i] = triangles[i] + v / 3;
      v += p.length;
      c += triangles.length;
    }
    const geometry = new T.BufferGeometry();
    geometry.setAttribute("position", new T.BufferAttribute(positions, 3));
    geometry.setAttribute("color", new T.BufferAttribute(colors, 3, true));
    geometry.setIndex(new T.BufferAttribute(index, 1));
    geometry.computeBoundingSphere();
    return geometry;
  }

  // Cheap enough for computers without a graphics card: light by the surface's slope alone, on colours as they are shown.
  const VERTEX = `
    varying vec3 at;
    varying vec3 paint;
    void main() {
      vec4 world = modelMatrix * vec4(position, 1.0);
      at = world.xyz;
      paint = color;
      gl_Position = projectionMatrix * (viewMatrix * world);
    }`;
  const FRAGMENT = `
    varying vec3 at;
    varying vec3 paint;
    void main() {
      vec3 normal = normalize(cross(dFdx(at), dFdy(at)));
      float sun = max(dot(normal, vec3(-0.48, -0.29, 0.83)), 0.0);
      gl_FragColor = vec4(paint * (0.74 + 0.12 * normal.z + 0.38 * sun), 1.0);
    }`;
  const surface = (T) =>
    new T.ShaderMaterial({ vertexShader: VERTEX, fragmentShader: FRAGMENT, vertexColors: true, side: T.DoubleSide });

  function made(T, packed) {
    const meshes = packed.meshes.map(unpacked);
    const cells = new Map();
    for (const one of packed.stands) {
      const { from, size } = packed.meshes[one.mesh];
      const middle = from.map((value, axis) => value + size[axis] / 2);
      const at = [0, 4].map((r) => one.pose[r] * middle[0] + one.pose[r + 1] * middle[1] + one.pose[r + 2] * middle[2] + one.pose[r + 3]);
      // What is wide, such as the ground, would make its cell as wide.
      const isWide = Math.max(size[0], size[1]) > 2 * CELL_M;
      const cell = isWide ? `wide ${cells.size}` : at.map((value) => Math.floor(value / CELL_M)).join();
      if (!cells.has(cell)) cells.set(cell, []);
      cells.get(cell).push(one);
    }
    const bodies = new Map(Object.entries(packed.bodies).map(([id, placed]) => [+id, joined(T, meshes, placed)]));
    return {
      stands: [...cells.values()].map((placed) => joined(T, meshes, placed)),
      coarse: joined(T, meshes, packed.coarse),
      bodies,
    };
  }
  return { made, surface };
})();
