"use strict";
// The page of `trove view`. What it shows at first stands in #run (scenes, moments, cameras); what a scene and a frame
// hold comes as chunks: from the page, or by scripts `chunk(name, content)` from the folder beside it, since scripts are
// all that browsers let a file read from another one.
(() => {
  const run = JSON.parse(document.getElementById("run").textContent);
  const $ = (id) => document.getElementById(id);
  const classOf = new Map(run.classes.map((row) => [row.id, row]));
  const css = (rgb) => `rgb(${rgb.join(",")})`;
  const layers = ["none", ...run.layers, "boxes"];
  const state = {
    scene: 0,
    moment: 0,
    view: 0,
    layer: layers.includes("class") ? "class" : "none",
    opacity: 60,
    other: "",
    split: 50,
    hidden: new Set(),
    picked: null,
  };

  const scene = () => run.scenes[state.scene];
  const moment = () => scene().moments[state.moment];
  const shown = () => moment().frames[Math.min(state.view, moment().frames.length - 1)];

  // ---- chunks, of which a few are kept ----
  const KEPT = 6;
  const kept = new Map();
  const waiting = new Map();
  window.chunk = (name, content) => waiting.get(name)?.(content);

  function load(name) {
    const inside = document.getElementById(name);
    if (inside) return Promise.resolve(JSON.parse(inside.textContent));
    const { promise, resolve, reject } = Promise.withResolvers();
    const script = document.createElement("script");
    waiting.set(name, resolve);
    script.onerror = () => reject(new Error(`${run.folder}/${name}.js cannot be read: keep that folder beside the page`));
    script.src = `${run.folder}/${name}.js`.split("/").map(encodeURIComponent).join("/");
    document.head.append(script);
    return promise.finally(() => (script.remove(), waiting.delete(name)));
  }

  function chunk(name, prepared = (content) => content) {
    if (!kept.has(name)) {
      const loaded = load(name).then(prepared);
      loaded.catch(() => kept.delete(name));
      kept.set(name, loaded);
      if (kept.size > KEPT) kept.delete(kept.keys().next().value);
    } else {
      // What was used last is thrown away last.
      const again = kept.get(name);
      kept.delete(name);
      kept.set(name, again);
    }
    return kept.get(name);
  }
  const frameChunk = (frame) => chunk(frame.id, (content) => ({ ...content, read: new Map() }));
  const sceneChunk = () => chunk(scene().id);

  /** Not by an `Image`, whose pixels the browser keeps for long. */
  async function pixels(uri) {
    const bitmap = await createImageBitmap(await (await fetch(uri)).blob());
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
    const context = canvas.getContext("2d", { willReadFrequently: true });
    context.drawImage(bitmap, 0, 0);
    bitmap.close();
    return context.getImageData(0, 0, canvas.width, canvas.height);
  }

  async function image(frame, name) {
    const { images, read } = await frameChunk(frame);
    if (!(name in images)) return null;
    if (!read.has(name)) read.set(name, pixels(images[name]));
    return read.get(name);
  }

  // ---- the picture ----
  const canvas = $("picture");
  const context = canvas.getContext("2d");

  /** A colour for a number, far from those of its neighbours. */
  function hue(id) {
    const [h, s, l] = [(id * 137.508) % 360, 0.65, 0.55];
    const a = s * Math.min(l, 1 - l);
    return [0, 8, 4].map((n) => {
      const k = (n + h / 30) % 12;
      return Math.round(255 * (l - a * Math.max(-1, Math.min(k - 3, 9 - k, 1))));
    });
  }

  // From near to far, even steps of the logarithm between 1 and 300 m.
  const RAMP = [[252, 253, 191], [254, 159, 109], [222, 73, 104], [140, 41, 129], [59, 15, 112], [8, 6, 28]];
  function ramp(depth_m) {
    if (depth_m === Infinity) return [0, 0, 0];
    const at = (RAMP.length - 1) * Math.max(0, Math.min(1, Math.log(depth_m) / Math.log(300)));
    const i = Math.min(RAMP.length - 2, Math.floor(at));
    return RAMP[i].map((c, axis) => Math.round(c + (at - i) * (RAMP[i + 1][axis] - c)));
  }

  const PAINTS = {
    class: { from: "labels", number: (d, i) => d[i], color: (id) => classOf.get(id)?.rgb ?? [0, 0, 0] },
    instance: { from: "labels", number: (d, i) => d[i + 1] * 256 + d[i + 2], color: (id) => (id ? hue(id) : null) },
    depth: { from: "depth", number: (d, i) => d[i + 1] * 256 + d[i + 2], color: (step) => ramp(metres(step)) },
  };

  /** The layer as pixels that are laid over the image. */
  async function layerOf(frame) {
    const paint = PAINTS[state.layer];
    if (!paint) return run.layers.includes(state.layer) ? image(frame, state.layer) : null;
    const numbers = await image(frame, paint.from);
    if (!numbers) return null;
    const { data, width, height } = numbers;
    const [out, colors] = [new ImageData(width, height), new Map()];
    for (let i = 0; i < data.length; i += 4) {
      const number = paint.number(data, i);
      let color = colors.get(number);
      if (color === undefined) colors.set(number, (color = paint.color(number)));
      if (!color || (paint.from === "labels" && state.hidden.has(data[i]))) continue;
      out.data[i] = color[0];
      out.data[i + 1] = color[1];
      out.data[i + 2] = color[2];
      out.data[i + 3] = 255;
    }
    return out;
  }

  /** The image of a frame with its layer; what lies on it is drawn later. */
  async function painted(frame) {
    const [rgb, layer] = await Promise.all([image(frame, "rgb"), layerOf(frame)]);
    const out = new OffscreenCanvas(frame.width, frame.height);
    const to = out.getContext("2d");
    to.fillRect(0, 0, out.width, out.height);
    if (rgb) to.putImageData(rgb, 0, 0);
    if (layer) {
      const over = new OffscreenCanvas(layer.width, layer.height);
      over.getContext("2d").putImageData(layer, 0, 0);
      to.globalAlpha = rgb ? state.opacity / 100 : 1;
      to.drawImage(over, 0, 0, out.width, out.height);
    }
    return out;
  }

  /** The same camera and moment in the variation that is compared with. */
  function counterpart(frame) {
    const other = run.scenes.find((row) => row.id === state.other);
    const there = other?.moments.find((row) => row.keyframe === moment().keyframe);
    return there?.frames.find((row) => row.view === frame.view) ?? null;
  }

  let drawn = 0;
  async function draw() {
    const mine = ++drawn;
    const frame = shown();
    if (!frame?.has_images) return;
    try {
      const other = counterpart(frame);
      const [own, compared, { objects }] = await Promise.all([painted(frame), other && painted(other), frameChunk(frame)]);
      if (mine !== drawn) return;
      $("fault").textContent = "";
      canvas.width = frame.width;
      canvas.height = frame.height;
      canvas.classList.toggle("large", canvas.clientWidth > 1.5 * frame.width);
      context.drawImage(own, 0, 0);
      if (compared) {
        const at = Math.round((state.split / 100) * frame.width);
        context.drawImage(compared, at, 0, frame.width - at, frame.height, at, 0, frame.width - at, frame.height);
        context.fillStyle = "#fff";
        context.fillRect(at - 1, 0, Math.max(2, frame.width / 400), frame.height);
      }
      if (state.layer === "boxes") for (const thing of objects) outline(frame, thing, css(classOf.get(thing.class_id).rgb));
      const { picked } = state;
      if (picked) {
        const thing = objects.find((row) => row.id === picked.id);
        if (thing) outline(frame, thing, "#ff2e88");
        if (picked.frame === frame.id && picked.x !== undefined) cross(picked);
      }
      canvas.dataset.shows = frame.id;
    } catch (error) {
      if (mine === drawn) $("fault").textContent = error.message;
    }
  }

  function outline(frame, thing, color) {
    if (!thing.box || state.hidden.has(thing.class_id)) return;
    const [x0, y0, x1, y1] = thing.box;
    context.lineWidth = Math.max(1, frame.width / 600);
    context.strokeStyle = color;
    context.strokeRect(x0, y0, x1 - x0, y1 - y0);
  }

  function cross({ x, y }) {
    const arm = canvas.width / 60;
    for (const [color, width] of [["#000", 3], ["#fff", 1]]) {
      context.strokeStyle = color;
      context.lineWidth = (width * canvas.width) / 800;
      context.beginPath();
      for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
        context.moveTo(x + 0.5 + (dx * arm) / 4, y + 0.5 + (dy * arm) / 4);
        context.lineTo(x + 0.5 + dx * arm, y + 0.5 + dy * arm);
      }
      context.stroke();
    }
  }

  // ---- picking ----
  const metres = (step) => (step ? run.depth.near_m * Math.exp((step - 1) * run.depth.step) : Infinity);

  async function pick(x, y) {
    const frame = shown();
    x = Math.max(0, Math.min(frame.width - 1, x));
    y = Math.max(0, Math.min(frame.height - 1, y));
    const [labels, depth, { objects }] = await Promise.all([image(frame, "labels"), image(frame, "depth"), frameChunk(frame)]);
    const i = 4 * (y * frame.width + x);
    const picked = { frame: frame.id, x, y };
    if (labels) {
      picked.class = classOf.get(labels.data[i])?.name;
      picked.id = labels.data[i + 1] * 256 + labels.data[i + 2];
    }
    if (depth) picked.depth_m = metres(depth.data[i + 1] * 256 + depth.data[i + 2]);
    picked.thing = objects.find((thing) => thing.id === picked.id) ?? null;
    setPicked(picked);
    return picked;
  }

  /** What a box in the scene stands for; `null` for nothing. */
  function pickThing(thing) {
    setPicked(thing && { id: thing.id, class: classOf.get(thing.class_id)?.name, thing });
  }

  function setPicked(picked) {
    state.picked = picked;
    const { x, y, class: name, id, depth_m, thing } = picked ?? {};
    const rows = [
      ["pixel", x !== undefined && `${x}, ${y}`],
      ["class", name?.replaceAll("_", " ")],
      ["depth", depth_m !== undefined && (depth_m === Infinity ? "sky" : `${depth_m.toFixed(2)} m`)],
      ["object", id],
      ["kind", thing?.kind?.replaceAll("_", " ")],
      ["model", thing?.asset],
      ["size", thing?.size && `${thing.size.map((side) => side.toFixed(2)).join(" × ")} m`],
      ["range", thing?.range_m && `${thing.range_m.toFixed(1)} m`],
      ["box", thing?.box?.join(", ")],
      ["pixels", thing?.visible_px],
      ["hidden", thing?.occlusion !== undefined && `${Math.round(100 * thing.occlusion)} %`],
      ["states", thing?.states?.join(", ")],
      ["category", thing?.category],
      ["origin", thing?.origin],
    ];
    $("picked").replaceChildren();
    for (const [term, value] of rows) {
      if (!value) continue;
      const [dt, dd] = [document.createElement("dt"), document.createElement("dd")];
      dt.textContent = term;
      dd.textContent = value;
      $("picked").append(dt, dd);
    }
    $("nothing").hidden = Boolean(picked);
    refresh();
  }

  canvas.addEventListener("click", (event) => {
    const at = canvas.getBoundingClientRect();
    const frame = shown();
    pick(
      Math.floor(((event.clientX - at.left) / at.width) * frame.width),
      Math.floor(((event.clientY - at.top) / at.height) * frame.height),
    );
  });
  canvas.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (!step) return;
    const frame = shown();
    const { picked } = state;
    const at = picked?.frame === frame.id ? picked : { x: frame.width >> 1, y: frame.height >> 1 };
    event.preventDefault();
    event.stopPropagation();
    const far = event.shiftKey ? 10 : 1;
    pick(at.x + step[0] * far, at.y + step[1] * far);
  });

  // ---- the scene in three dimensions ----
  let three = null;
  try {
    three = world($("world"), { scene, moment, shown, state, classOf, choose, pickThing, chunk: sceneChunk });
  } catch (error) {
    $("world").parentElement.querySelector(".tools").textContent = `No picture of the scene: ${error.message}`;
  }
  async function refresh() {
    draw();
    if (!three) return;
    const own = scene();
    try {
      const content = await sceneChunk();
      if (own === scene()) three.show(content);
    } catch (error) {
      $("fault").textContent = error.message;
    }
  }

  // ---- controls ----
  function choose(changes) {
    Object.assign(state, changes);
    state.moment = Math.max(0, Math.min(scene().moments.length - 1, state.moment));
    state.view = Math.max(0, Math.min(moment().frames.length - 1, state.view));
    const siblings = run.scenes.filter((row) => row.scene === scene().scene && row !== scene());
    if (!siblings.some((row) => row.id === state.other)) state.other = "";
    $("scene").value = state.scene;
    $("moment").max = scene().moments.length - 1;
    $("moment").value = state.moment;
    $("moment").setAttribute("aria-valuetext", `keyframe ${moment().keyframe}`);
    $("moment-now").value = moment().keyframe;
    $("opacity").value = state.opacity;
    $("opacity-now").value = `${state.opacity} %`;
    $("split").value = state.split;
    $("split-now").value = `${state.split} %`;
    $("comparing").hidden = !siblings.length || !shown()?.has_images;
    $("splits").hidden = !state.other;
    const options = [new Option("nothing", ""), ...siblings.map((row) => new Option(row.name, row.id))];
    $("other").replaceChildren(...options);
    $("other").value = state.other;
    const has = Boolean(shown()?.has_images);
    for (const name of ["images", "layers", "opacities"]) $(name).hidden = !has;
    $("without").hidden = has;
    document.querySelector("main").classList.toggle("bare", !has);
    pressed($("cameras"), moment().frames.map((frame) => frame.view), shown()?.view, (_, i) => choose({ view: i }));
    pressed($("layers"), layers, state.layer, (name) => choose({ layer: name }));
    remember();
    refresh();
  }

  function pressed(group, names, now, then) {
    if ([...group.children].map((button) => button.dataset.name).join() !== names.join()) {
      group.replaceChildren(
        ...names.map((name, i) => {
          const button = document.createElement("button");
          button.type = "button";
          button.dataset.name = name;
          button.textContent = name.replace(/^ego\./, "").replace(/CAM_/, "").replaceAll(/[._]/g, " ").toLowerCase();
          button.onclick = () => then(name, i);
          return button;
        }),
      );
    }
    for (const button of group.children) button.setAttribute("aria-pressed", String(button.dataset.name === now));
  }

  for (const [i, row] of run.scenes.entries()) $("scene").add(new Option(row.name, i));
  $("scenes").hidden = run.scenes.length < 2;
  $("scene").onchange = (event) => choose({ scene: +event.target.value, moment: 0, picked: null });
  $("moment").oninput = (event) => choose({ moment: +event.target.value });
  $("opacity").oninput = (event) => choose({ opacity: +event.target.value });
  $("other").onchange = (event) => choose({ other: event.target.value });
  $("split").oninput = (event) => choose({ split: +event.target.value });
  $("about").textContent = run.about;

  const boxes = new Map();
  for (const row of run.classes) {
    const [item, label, box, swatch] = ["li", "label", "input", "span"].map((name) => document.createElement(name));
    box.type = "checkbox";
    box.checked = true;
    box.onchange = () => hide(row.id, !box.checked);
    boxes.set(row.id, box);
    swatch.className = "swatch";
    swatch.style.background = css(row.rgb);
    label.append(box, swatch, row.name.replaceAll("_", " "));
    item.append(label);
    $("legend").append(item);
  }
  function hide(id, hidden) {
    boxes.get(id).checked = !hidden;
    state.hidden[hidden ? "add" : "delete"](id);
    refresh();
  }
  $("all").onclick = () => run.classes.forEach((row) => hide(row.id, false));
  $("none").onclick = () => run.classes.forEach((row) => hide(row.id, true));

  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|SELECT)$/.test(event.target.tagName)) return;
    const digit = /^[1-9]$/.test(event.key) && layers[event.key - 1];
    const keys = {
      ArrowLeft: () => choose({ moment: state.moment - 1 }),
      ArrowRight: () => choose({ moment: state.moment + 1 }),
      "[": () => choose({ view: state.view - 1 }),
      "]": () => choose({ view: state.view + 1 }),
      v: () => choose({ scene: nextVariation() }),
      c: () => three?.through(),
      o: () => three?.overview(),
    };
    const action = digit ? () => choose({ layer: digit }) : keys[event.key];
    if (!action) return;
    event.preventDefault();
    action();
  });

  function nextVariation() {
    const same = [...run.scenes.keys()].filter((i) => run.scenes[i].scene === scene().scene);
    return same[(same.indexOf(state.scene) + 1) % same.length];
  }

  // ---- links that keep the view ----
  function remember() {
    const words = new URLSearchParams({ frame: shown()?.id ?? scene().id, layer: state.layer, opacity: state.opacity });
    if (state.other) words.set("other", state.other);
    history.replaceState(null, "", `#${words}`);
  }

  /** The first frame that is shown: by preference one that looks ahead. */
  function ahead() {
    const { ego, frames } = moment();
    const forward = ({ pose }) => (ego ? pose[2] * ego[0] + pose[6] * ego[4] + pose[10] * ego[8] : 0);
    const most = Math.max(...frames.map(forward));
    return Math.max(0, frames.findIndex((frame) => forward(frame) === most));
  }

  function recall() {
    const words = new URLSearchParams(location.hash.slice(1));
    const wanted = words.get("frame");
    const changes = { view: ahead(), other: words.get("other") ?? "" };
    if (layers.includes(words.get("layer"))) changes.layer = words.get("layer");
    if (words.has("opacity")) changes.opacity = Math.max(0, Math.min(100, Number(words.get("opacity")) || 0));
    for (const [s, row] of run.scenes.entries()) {
      for (const [m, at] of row.moments.entries()) {
        const v = at.frames.findIndex((frame) => frame.id === wanted);
        if (v >= 0) Object.assign(changes, { scene: s, moment: m, view: v });
      }
    }
    choose(changes);
  }
  window.addEventListener("hashchange", recall);
  recall();
  window.trove = { state, pick, three, shown, kept };
})();
