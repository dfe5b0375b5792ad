"use strict";
// The scene in three dimensions: what stands and drives, boxes, tracks over time, lanes, and the cameras that jump to
// their frames.
function world(canvas, page) {
  const T = THREE;
  const scene = new T.Scene();
  const camera = new T.PerspectiveCamera(55, 1, 0.3, 3000);
  camera.up.set(0, 0, 1);
  const renderer = new T.WebGLRenderer({ canvas });
  const controls = new T.OrbitControls(camera, canvas);
  controls.zoomToCursor = true;
  controls.maxDistance = 1500;
  const groups = {};
  for (const name of ["shapes", "boxes", "tracks", "lanes", "cameras"]) groups[name] = new T.Group();
  scene.add(...Object.values(groups));
  const surface = shapes.surface(T);
  const [stands, coarse, movers] = [new T.Group(), new T.Group(), new T.Group()];
  groups.shapes.add(stands, coarse, movers);

  // ---- drawing: finely at rest; while it moves as finely as thirty frames a second allow ----
  const PIXEL = Math.min(devicePixelRatio, 1.5);
  const REST = { ratio: 2 * PIXEL, fine: true };
  const MOVING = [
    { ratio: PIXEL, fine: true },
    { ratio: 0.6 * PIXEL, fine: true },
    { ratio: 0.75 * PIXEL, fine: false },
    { ratio: 0.45 * PIXEL, fine: false },
    { ratio: 0.33 * PIXEL, fine: false },
  ];
  const [REST_MS, SLOW_MS, FAST_MS] = [250, 28, 9];
  const gl = renderer.getContext();
  let [wanted, resting, level] = [false, 0, 0];
  /** What is being drawn: that happens elsewhere, so that only a fence tells when it has ended. */
  let under = null;
  function redraw() {
    clearTimeout(resting);
    resting = setTimeout(rest, REST_MS);
    if (wanted) return;
    wanted = true;
    requestAnimationFrame(next);
  }
  function rest() {
    if (under) resting = setTimeout(rest, REST_MS);
    else draw(REST);
  }
  function next() {
    if (under) return requestAnimationFrame(next);
    wanted = false;
    draw(MOVING[level]);
  }
  function watch() {
    const { sync, begun, how } = under;
    if (gl.getSyncParameter(sync, gl.SYNC_STATUS) !== gl.SIGNALED) return setTimeout(watch, 2);
    gl.deleteSync(sync);
    under = null;
    const took = performance.now() - begun;
    if (took > SLOW_MS && (how === REST ? took > 4 * SLOW_MS : true)) level = Math.min(MOVING.length - 1, level + 1);
    else if (how !== REST && took < FAST_MS) level = Math.max(0, level - 1);
  }
  function draw(how) {
    const [w, h] = [canvas.clientWidth, canvas.clientHeight];
    if (!w || !h) return;
    if (canvas.width !== Math.floor(w * how.ratio) || canvas.height !== Math.floor(h * how.ratio)) {
      renderer.setPixelRatio(how.ratio);
      renderer.setSize(w, h, false);
      camera.aspect = w / h;
      camera.updateProjectionMatrix();
    }
    // Boxes tell who moves.
    stands.visible = movers.visible = how.fine;
    coarse.visible = !how.fine;
    renderer.render(scene, camera);
    under = { sync: gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0), begun: performance.now(), how };
    gl.flush();
    setTimeout(watch, 2);
  }
  new ResizeObserver(redraw).observe(canvas);
  controls.addEventListener("change", redraw);
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const backdrop = () => ((scene.background = new T.Color(dark.matches ? 0x22262c : 0xdfe6ee)), redraw());
  dark.addEventListener("change", backdrop);
  backdrop();

  const linear = (rgb) => new T.Color().setRGB(...rgb.map((c) => c / 255), T.SRGBColorSpace).toArray();
  const classColor = (id) => linear(page.classOf.get(id)?.rgb ?? [128, 128, 128]);

  function lines(group, { points, colors }) {
    const geometry = new T.BufferGeometry();
    geometry.setAttribute("position", new T.BufferAttribute(new Float32Array(points), 3));
    geometry.setAttribute("color", new T.BufferAttribute(new Float32Array(colors), 3));
    group.add(new T.LineSegments(geometry, new T.LineBasicMaterial({ vertexColors: true })));
  }
  function empty(group) {
    for (const child of group.children) {
      child.geometry.dispose();
      if (child.material !== surface) child.material.dispose();
    }
    group.clear();
  }
  /** Segments of a polyline, lifted off the ground. */
  function along(points, rgb, into, lift = 0) {
    for (let i = 1; i < points.length; i++) {
      for (const [x, y, z] of [points[i - 1], points[i]]) into.points.push(x, y, z + lift);
      into.colors.push(...rgb, ...rgb);
    }
  }

  // Rows of a 3 × 4 pose.
  const apply = (pose, [x, y, z]) => [0, 4, 8].map((r) => pose[r] * x + pose[r + 1] * y + pose[r + 2] * z + pose[r + 3]);
  const PICKED = [1, 0, 0.45];
  const EDGES = [0, 1, 2, 3, 4, 5, 6, 7, 0, 2, 1, 3, 4, 6, 5, 7, 0, 4, 1, 5, 2, 6, 3, 7];
  function box(thing, rgb, into) {
    const corner = (i) => apply(thing.pose, thing.size.map((s, axis) => (i & (1 << axis) ? s / 2 : -s / 2)));
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map(corner);
    for (const i of EDGES) into.points.push(...corners[i]), into.colors.push(...rgb);
    // A line ahead, on the ground.
    const [l, , h] = thing.size;
    into.points.push(...apply(thing.pose, [0, 0, -h / 2]), ...apply(thing.pose, [l / 2, 0, -h / 2]));
    into.colors.push(...rgb, ...rgb);
  }

  // ---- cameras, which jump to their frame ----
  const REACH_M = 1.6;
  let frusta = [];
  function frustum(frame, rgb, into) {
    const { pose, k, width, height } = frame;
    const eye = [pose[3], pose[7], pose[11]];
    const far = (u, v) => apply(pose, [((u - k[2]) / k[0]) * REACH_M, ((v - k[3]) / k[1]) * REACH_M, REACH_M]);
    const corners = [far(0, 0), far(width, 0), far(width, height), far(0, height)];
    for (let i = 0; i < 4; i++) {
      into.points.push(...eye, ...corners[i], ...corners[i], ...corners[(i + 1) % 4]);
      for (let n = 0; n < 4; n++) into.colors.push(...rgb);
    }
    frusta.push({ frame, at: new T.Vector3(...apply(pose, [0, 0, REACH_M * 0.6])) });
  }

  // ---- what is the same in all moments ----
  const STANDING_M = 0.3;
  let place = null;
  let bodies = new Map();
  function settle(own, chunk) {
    place = own;
    for (const body of bodies.values()) body.dispose();
    for (const group of [stands, coarse, groups.lanes, groups.tracks]) empty(group);
    bodies = new Map();
    if (chunk.shapes) {
      const made = shapes.made(T, chunk.shapes);
      bodies = made.bodies;
      for (const geometry of made.stands) stands.add(new T.Mesh(geometry, surface));
      coarse.add(new T.Mesh(made.coarse, surface));
    }
    const flat = { points: [], colors: [] };
    const paint = { lanes: [0.1, 0.35, 0.85], lines: [0.75, 0.75, 0.7], kerbs: [0.4, 0.4, 0.4] };
    // Shapes have kerbs of their own.
    if (chunk.shapes) delete paint.kerbs;
    for (const [kind, rgb] of Object.entries(paint)) for (const points of chunk[kind]) along(points, rgb, flat, 0.06);
    along(chunk.way, [0.9, 0.2, 0.1], flat, 0.1);
    lines(groups.lanes, flat);
    const ways = new Map();
    for (const things of chunk.moments) {
      for (const thing of things) {
        if (!ways.has(thing.id)) ways.set(thing.id, { class_id: thing.class_id, points: [] });
        const { points } = ways.get(thing.id);
        const at = apply(thing.pose, [0, 0, 0.1 - thing.size[2] / 2]);
        const before = points.at(-1);
        if (!before || Math.hypot(at[0] - before[0], at[1] - before[1]) > STANDING_M) points.push(at);
      }
    }
    const tracks = { points: [], colors: [] };
    for (const { class_id, points } of ways.values()) along(points, classColor(class_id), tracks);
    lines(groups.tracks, tracks);
  }

  function look(from, to) {
    camera.position.set(...from);
    controls.target.set(...to);
    controls.update();
    redraw();
  }

  /** From above and behind the vehicle. */
  function overview() {
    const { ego, frames } = page.moment();
    const pose = ego ?? frames[0]?.pose ?? [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0];
    const [x, y, z] = [pose[3], pose[7], pose[11]];
    const [ax, ay] = ego ? [pose[0], pose[4]] : [pose[2], pose[6]];
    look([x - 16 * ax, y - 16 * ay, z + 11], [x + 12 * ax, y + 12 * ay, z]);
  }

  /** Where the frame's camera stands, looking as it does. */
  function through() {
    const { pose } = page.shown();
    look([pose[3], pose[7], pose[11]], apply(pose, [0, 0, 12]));
  }

  /** Everything of the moment that is shown; `chunk` is its scene's. */
  function show(chunk) {
    const own = page.scene();
    if (place !== own) {
      const first = place?.scene !== own.scene;
      settle(own, chunk);
      if (first) overview();
    }
    for (const name of ["boxes", "cameras"]) empty(groups[name]);
    movers.clear();
    frusta = [];
    const [boxes, cameras] = [0, 0].map(() => ({ points: [], colors: [] }));
    for (const thing of things(chunk)) {
      const body = bodies.get(thing.id);
      if (body) {
        const mesh = new T.Mesh(body, surface);
        mesh.matrixAutoUpdate = false;
        mesh.matrix.set(...thing.pose, 0, 0, 0, 1);
        movers.add(mesh);
      }
      box(thing, page.state.picked?.id === thing.id ? PICKED : classColor(thing.class_id), boxes);
    }
    const scenery = chunk.scenery.find((thing) => thing.id === page.state.picked?.id);
    if (scenery) box(scenery, PICKED, boxes);
    const shown = page.shown();
    for (const frame of page.moment().frames) frustum(frame, frame === shown ? [1, 0.3, 0] : [0.2, 0.25, 0.4], cameras);
    lines(groups.boxes, boxes);
    lines(groups.cameras, cameras);
    redraw();
  }
  const things = (chunk) => (chunk.moments[page.state.moment] ?? []).filter((thing) => !page.state.hidden.has(thing.class_id));

  /** The camera whose frustum is nearest to a point of the canvas, within 25 pixels. */
  function nearest(x, y) {
    let [best, least] = [null, 25];
    for (const { frame, at } of frusta) {
      const seen = at.clone().project(camera);
      const d = Math.hypot(((seen.x + 1) / 2) * canvas.clientWidth - x, ((1 - seen.y) / 2) * canvas.clientHeight - y);
      if (seen.z < 1 && d < least) [best, least] = [frame, d];
    }
    return best;
  }

  /** The nearest road user whose box a point of the canvas shows. */
  function hit(chunk, x, y) {
    const far = new T.Vector3((2 * x) / canvas.clientWidth - 1, 1 - (2 * y) / canvas.clientHeight, 0.5).unproject(camera);
    const ray = far.sub(camera.position).normalize().toArray();
    let [best, least] = [null, Infinity];
    for (const thing of things(chunk)) {
      const { pose, size } = thing;
      const from = camera.position.toArray().map((value, r) => value - pose[4 * r + 3]);
      let [near, end] = [0, Infinity];
      for (let axis = 0; axis < 3; axis++) {
        const turned = (v) => [0, 1, 2].reduce((sum, r) => sum + pose[4 * r + axis] * v[r], 0);
        const [at, way] = [turned(from), turned(ray)];
        const ends = [(-size[axis] / 2 - at) / way, (size[axis] / 2 - at) / way];
        near = Math.max(near, Math.min(...ends));
        end = Math.min(end, Math.max(...ends));
      }
      if (near <= end && near < least) [best, least] = [thing, near];
    }
    return best;
  }

  let pressed = null;
  canvas.addEventListener("pointerdown", (event) => (pressed = [event.offsetX, event.offsetY]));
  canvas.addEventListener("pointerup", async (event) => {
    if (!pressed || Math.hypot(event.offsetX - pressed[0], event.offsetY - pressed[1]) > 4) return;
    const frame = nearest(event.offsetX, event.offsetY);
    if (frame) return page.choose({ view: page.moment().frames.indexOf(frame) });
    page.pickThing(hit(await page.chunk(), event.offsetX, event.offsetY));
  });
  const TURN_RAD = 0.08;
  const STEP_M = 2;
  canvas.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const offset = camera.position.clone().sub(controls.target);
    const ahead = offset.clone().setZ(0).normalize().negate();
    const left = new T.Vector3(-ahead.y, ahead.x, 0);
    const up = new T.Vector3(0, 0, 1);
    const fly = { w: ahead, s: ahead.clone().negate(), a: left, d: left.clone().negate(), e: up, q: up.clone().negate() }[event.key];
    const zoom = { "+": 0.85, "=": 0.85, "-": 1 / 0.85 }[event.key];
    const turn = { ArrowLeft: [up, -TURN_RAD], ArrowRight: [up, TURN_RAD], ArrowUp: [left, -TURN_RAD], ArrowDown: [left, TURN_RAD] }[event.key];
    if (fly) {
      camera.position.addScaledVector(fly, STEP_M);
      controls.target.addScaledVector(fly, STEP_M);
    } else if (zoom) camera.position.copy(controls.target).addScaledVector(offset, zoom);
    else if (turn) camera.position.copy(controls.target).add(offset.applyAxisAngle(...turn));
    else return;
    event.preventDefault();
    event.stopPropagation();
    controls.update();
    redraw();
  });

  const tools = canvas.parentElement.querySelector(".tools");
  function tool(name, then) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = name;
    button.onclick = () => (then(button), redraw());
    tools.append(button);
    return button;
  }
  for (const [name, group] of Object.entries(groups)) {
    const toggled = tool(name, (button) => {
      group.visible = !group.visible;
      button.setAttribute("aria-pressed", String(group.visible));
    });
    toggled.setAttribute("aria-pressed", "true");
  }
  tool("overview", overview);
  tool("through the camera", through);

  return { show, overview, through, camera, controls, canvas, renderer, scene, apply };
}
