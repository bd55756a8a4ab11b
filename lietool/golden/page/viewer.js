// ---- two pictures, compared -----------------------------------------------------------------------

const all = (selector, root = document) => [...root.querySelectorAll(selector)];
const one = (selector, root = document) => root.querySelector(selector);
const root = document.documentElement;
const clamp = (value, low, high) => Math.min(Math.max(value, low), high);
const still = matchMedia("(prefers-reduced-motion: reduce)");

const viewer = (() => {
  const host = one("#_viewer"), stage = one(".stage", host), panes = all(".pane", stage);
  const worlds = all(".world", stage), layer = {};
  for (const part of ["expected", "actual", "difference", "ssim"]) layer[part] = one(`.${part}`, worlds[0]);
  const called = host.dataset, loupe = one(".loupe", host), divider = one(".divider", stage);
  const GAINS = [1, 2, 4, 8, 16, 32, 64, 128], MODES = ["swipe", "blink", "side", "difference", "ssim"];
  const STEPS = [0.25, 0.5, 1, 2, 3, 4, 6, 8, 12, 16, 24], GHOST = 0.15, SPAN = 17, PERIOD = 700;
  const view = { mode: "swipe", split: 50, gain: 4, boxes: true, loupe: true, scale: null, x: 0, y: 0, point: null, place: -1 };
  let about = null, size = [1, 1], pixels = {}, available = [], timer = 0, second = false, turn = 0;

  // ---- colours ----

  const read = (image) => {
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [image.naturalWidth, image.naturalHeight];
    const context = canvas.getContext("2d", { willReadFrequently: true });
    context.drawImage(image, 0, 0);
    return context.getImageData(0, 0, canvas.width, canvas.height);
  };
  const linear = (level) => (level <= 0.04045 ? level / 12.92 : ((level + 0.055) / 1.055) ** 2.4);
  const lab = ([r, g, b]) => {
    [r, g, b] = [r, g, b].map((level) => linear(level / 255));
    const [x, y, z] = [
      (0.412453 * r + 0.357580 * g + 0.180423 * b) / 0.95047,
      0.212671 * r + 0.715160 * g + 0.072169 * b,
      (0.019334 * r + 0.119193 * g + 0.950227 * b) / 1.08883,
    ].map((t) => (t > (6 / 29) ** 3 ? Math.cbrt(t) : (t * (29 / 6) ** 2) / 3 + 4 / 29));
    return [116 * y, 500 * (x - y), 200 * (y - z)];
  };
  const colour = (data, x, y) => {
    if (!data || x < 0 || y < 0 || x >= data.width || y >= data.height) return null;
    const start = 4 * (y * data.width + x);
    return [...data.data.subarray(start, start + 3)];
  };
  // The signed difference about mid-grey, over a ghost of what was expected: as `figures verify` leaves it.
  const subtract = () => {
    const { expected, actual } = pixels, canvas = layer.difference;
    if (!expected || !actual || !available.includes("difference")) return;
    const gain = GAINS[view.gain], a = expected.data, b = actual.data;
    const result = new ImageData(expected.width, expected.height), out = result.data;
    for (let i = 0; i < a.length; i += 4) {
      const ghost = 128 + GHOST * ((a[i] + a[i + 1] + a[i + 2]) / 3 - 128);
      out[i] = ghost + gain * (b[i] - a[i]);
      out[i + 1] = ghost + gain * (b[i + 1] - a[i + 1]);
      out[i + 2] = ghost + gain * (b[i + 2] - a[i + 2]);
      out[i + 3] = 255;
    }
    [canvas.width, canvas.height] = [result.width, result.height];
    canvas.getContext("2d").putImageData(result, 0, 0);
  };

  // ---- where one looks ----

  const fit = () => {
    const { clientWidth: width, clientHeight: height } = panes[0];
    return Math.min(width / size[0], height / size[1]) || 1;
  };
  const scale = () => (view.scale === null ? fit() : Math.max(view.scale, fit()));
  const centre = () => {
    const s = scale(), { clientWidth: width, clientHeight: height } = panes[0];
    const half = [width / s / 2, height / s / 2];
    const along = (i, at) => (2 * half[i] >= size[i] ? size[i] / 2 : clamp(at, half[i], size[i] - half[i]));
    [view.x, view.y] = [along(0, view.x), along(1, view.y)];
    return { s, left: width / 2 - s * view.x, top: height / 2 - s * view.y };
  };
  const layout = () => {
    if (host.hidden) return;
    const { s, left, top } = centre();
    for (const world of worlds) {
      world.style.transform = `translate(${left}px, ${top}px) scale(${s})`;
      world.style.setProperty("--scale", s);
    }
    stage.classList.toggle("coarse", s > 1.5);
    stage.classList.toggle("movable", s > fit() * 1.001);
    const at = panes[0].clientWidth * (view.split / 100);
    divider.style.left = `${at}px`;
    const cut = clamp((at - left) / s, 0, size[0]);
    layer.actual.style.clipPath = view.mode === "swipe" && available.includes("swipe") ? `inset(0 0 0 ${cut}px)` : "";
    one("#_scale").textContent = view.scale === null ? "Fit" : `${Math.round(100 * s)}%`;
    if (!loupe.hidden) magnify();
  };
  const zoom = (next, at = view.point ?? [view.x, view.y]) => {
    const before = scale();
    view.scale = next <= fit() * 1.001 ? null : next;
    // What is under the pointer stays there.
    const ratio = before / scale();
    view.x = at[0] + (view.x - at[0]) * ratio;
    view.y = at[1] + (view.y - at[1]) * ratio;
    layout();
  };
  const nearer = (by, at) => {
    const s = scale();
    const next = by > 0 ? STEPS.find((step) => step > s * 1.001) : STEPS.findLast((step) => step < s * 0.999);
    zoom(next ?? s, at);
  };
  const go = ([x0, y0, x1, y1], point) => {
    const { clientWidth: width, clientHeight: height } = panes[0];
    const room = Math.min(width / (x1 - x0), height / (y1 - y0)) / 2.5;
    view.scale = clamp(room, 2, 12);
    if (view.scale <= fit()) view.scale = null;
    [view.x, view.y] = [(x0 + x1) / 2, (y0 + y1) / 2];
    view.point = point ?? [Math.floor(view.x), Math.floor(view.y)];
    layout();
  };
  // Within a box, where the loupe has most to show.
  const strongest = ([x0, y0, x1, y1]) => {
    let best = null, most = 0;
    for (let y = y0; y < y1; y++) for (let x = x0; x < x1; x++) {
      const a = colour(pixels.expected, x, y), b = colour(pixels.actual, x, y);
      const off = a && b ? Math.abs(a[0] - b[0]) + Math.abs(a[1] - b[1]) + Math.abs(a[2] - b[2]) : 0;
      if (off > most) [best, most] = [[x, y], off];
    }
    return best;
  };
  const place = (index) => {
    const { blobs = [] } = about ?? {};
    if (!blobs.length) return;
    view.place = (index + blobs.length) % blobs.length;
    for (const world of worlds) all(".blob", world).forEach((box, i) => box.classList.toggle("here", i === view.place));
    go(blobs[view.place], strongest(blobs[view.place]));
  };

  // ---- the loupe ----

  const hex = (c) => (c ? `#${c.map((v) => v.toString(16).padStart(2, "0")).join("")}` : "");
  const magnify = () => {
    const [x, y] = view.point ?? [size[0] >> 1, size[1] >> 1], half = SPAN >> 1;
    const source = { ...layer, actual: layer.actual.hidden && !pixels.actual ? layer.expected : layer.actual };
    for (const canvas of all("canvas", loupe)) {
      const context = canvas.getContext("2d"), unit = canvas.width / SPAN, part = canvas.dataset.part;
      context.imageSmoothingEnabled = false;
      context.clearRect(0, 0, canvas.width, canvas.height);
      if (pixels[part] || (part === "difference" && available.includes("difference")))
        context.drawImage(source[part], x - half, y - half, SPAN, SPAN, 0, 0, canvas.width, canvas.height);
      context.lineWidth = 1;
      for (const [grow, style] of [[0.5, "#fff"], [1.5, "#000"]]) {
        context.strokeStyle = style;
        context.strokeRect(half * unit - grow, half * unit - grow, unit + 2 * grow, unit + 2 * grow);
      }
      canvas.parentElement.hidden = part !== "expected" && !available.length && !pixels[part];
    }
    const [a, b] = [colour(pixels.expected, x, y), colour(pixels.actual, x, y)];
    const says = { expected: hex(a), actual: hex(b), difference: "" };
    let text = `(${x}, ${y})`;
    if (a && b) {
      says.difference = a.map((v, i) => { const d = b[i] - v; return d > 0 ? `+${d}` : d < 0 ? `−${-d}` : "0"; }).join(" ");
      const far = Math.hypot(...lab(a).map((v, i) => v - lab(b)[i]));
      text += far ? `  dE ${far.toFixed(1)}` : "  the same";
    }
    for (const part of Object.keys(says)) one(`[data-part=${part}] + figcaption span`, loupe).textContent = says[part];
    one(".point", loupe).textContent = text;
    // About the pixel, and never too small to be seen; none where nobody has pointed yet.
    const reach = Math.max(0.5, 5 / scale());
    for (const dot of all(".dot", stage)) {
      const box = { x: x + 0.5 - reach, y: y + 0.5 - reach, width: 2 * reach, height: 2 * reach };
      for (const [key, value] of Object.entries(box)) dot.setAttribute(key, value);
      dot.style.display = view.point ? "" : "none";
    }
  };
  const move = (dx, dy) => {
    const [x, y] = view.point ?? [size[0] >> 1, size[1] >> 1];
    view.point = [clamp(x + dx, 0, size[0] - 1), clamp(y + dy, 0, size[1] - 1)];
    const { s } = centre(), { clientWidth: width, clientHeight: height } = panes[0];
    // It never leaves what can be seen.
    view.x = clamp(view.x, view.point[0] - width / s / 2.2, view.point[0] + width / s / 2.2);
    view.y = clamp(view.y, view.point[1] - height / s / 2.2, view.point[1] + height / s / 2.2);
    layout();
  };

  // ---- the ways of looking ----

  const blink = (to = !second) => {
    second = to;
    layer.actual.style.visibility = second ? "" : "hidden";
    panes[0].classList.toggle("second-shown", second);
    one(".left", panes[0]).textContent = second ? called.actual : called.expected;
  };
  const running = () => timer !== 0;
  const run = (on) => {
    clearInterval(timer);
    timer = on ? setInterval(() => blink(), PERIOD) : 0;
    one("#_pause").textContent = on ? "Pause" : "Show the other";
  };
  const mode = (next = view.mode) => {
    view.mode = next;
    const now = available.includes(next) ? next : available[0] ?? "single";
    clearInterval(timer);
    timer = 0;
    stage.dataset.mode = now;
    // The picture goes to a pane of its own, and comes back below the layers that lie over it.
    if (now === "side") worlds[1].prepend(layer.actual);
    else layer.expected.after(layer.actual);
    layer.actual.style.visibility = "";
    panes[0].classList.remove("second-shown");
    const tags = { swipe: [called.expected, called.actual], side: [called.expected, ""], difference: ["difference", ""], ssim: [`1 − SSIM over ${called.expected}`, ""] };
    const [left, right] = tags[now] ?? [available.length ? "" : about.only, ""];
    one(".left", panes[0]).textContent = left;
    one(".right", panes[0]).textContent = right;
    one(".left", panes[1]).textContent = called.actual;
    for (const button of all("[data-mode]", host).filter((b) => b.matches("button"))) {
      button.setAttribute("aria-pressed", String(button.dataset.mode === now));
      button.disabled = !available.includes(button.dataset.mode);
    }
    for (const tool of all("[data-for]", host)) tool.hidden = tool.dataset.for !== now;
    one(".modes", host).hidden = !available.length;
    if (now === "blink") { blink(false); run(!still.matches); }
    layout();
  };
  const split = (value) => { view.split = clamp(value, 0, 100); one("#_split").value = view.split; layout(); };
  const gain = (value) => {
    view.gain = clamp(value, 0, GAINS.length - 1);
    one("#_gain").value = view.gain;
    one("#_gain").setAttribute("aria-valuetext", `${GAINS[view.gain]} times`);
    one("#_gain + output").textContent = `${GAINS[view.gain]}×`;
    subtract();
    layout();
  };
  const toggle = (what, on = !view[what]) => {
    view[what] = on;
    one(`#_${what}`).setAttribute("aria-pressed", String(on));
    host.classList.toggle(`no-${what}`, !on);
    if (what === "loupe") loupe.hidden = !on;
    layout();
  };

  // ---- a plate is put on the stage ----

  const draw = (boxes) => {
    const name = "http://www.w3.org/2000/svg";
    for (const svg of all("svg.boxes", stage)) {
      svg.setAttribute("viewBox", `0 0 ${size[0]} ${size[1]}`);
      svg.replaceChildren(...boxes.map(([x0, y0, x1, y1]) => {
        const rect = document.createElementNS(name, "rect");
        rect.setAttribute("class", "blob");
        for (const [key, value] of Object.entries({ x: x0 - 3, y: y0 - 3, width: x1 - x0 + 6, height: y1 - y0 + 6, rx: 2 })) rect.setAttribute(key, value);
        return rect;
      }));
      const dot = document.createElementNS(name, "rect");
      dot.setAttribute("class", "dot");
      svg.append(dot);
    }
  };
  const show = async (plate) => {
    const mine = ++turn;
    about = JSON.parse(plate.dataset.about);
    const sources = Object.fromEntries(all(".pictures img", plate).map((image) => [image.className, image]));
    host.hidden = !sources.expected && !sources.actual;
    if (host.hidden) { clearInterval(timer); timer = 0; return; }
    const first = sources.expected ?? sources.actual;
    pixels = {};
    for (const part of ["expected", "actual", "ssim"]) {
      const given = sources[part];
      layer[part].hidden = !given;
      if (given) layer[part].src = given.src;
      else layer[part].removeAttribute("src");
    }
    const seen = [first, sources.actual ?? first];
    size = [0, 1].map((i) => Math.max(...seen.map((image) => Number(image.getAttribute(i ? "height" : "width")))));
    for (const world of worlds) [world.style.width, world.style.height] = [`${size[0]}px`, `${size[1]}px`];
    stage.style.setProperty("--ratio", size[0] / size[1]);
    const both = Boolean(sources.expected && sources.actual);
    const alike = both && ["width", "height"].every((side) => sources.expected.getAttribute(side) === sources.actual.getAttribute(side));
    available = both ? MODES.filter((m) => (m === "difference" ? alike : m === "ssim" ? alike && sources.ssim : true)) : [];
    Object.assign(view, { scale: null, x: size[0] / 2, y: size[1] / 2, point: about.worst ?? null, place: -1 });
    draw(about.blobs);
    one(".pictures", plate).after(host);
    host.classList.toggle("single", !both);
    host.dataset.ready = "";
    mode();
    const loaded = ["expected", "actual"].filter((part) => sources[part]);
    await Promise.all(loaded.map((part) => layer[part].decode().catch(() => null)));
    if (mine !== turn) return;
    for (const part of loaded) if (layer[part].naturalWidth) pixels[part] = read(layer[part]);
    subtract();
    layout();
    host.dataset.ready = plate.id;
  };

  // ---- pointer ----

  const under = (event) => {
    const pane = event.target.closest(".pane") ?? panes[0];
    const box = pane.getBoundingClientRect(), { s, left, top } = centre();
    return { pane, at: [(event.clientX - box.left - left) / s, (event.clientY - box.top - top) / s], share: (100 * (event.clientX - box.left)) / box.width };
  };
  const look = (at) => {
    const point = at.map((v, i) => clamp(Math.floor(v), 0, size[i] - 1));
    if (view.loupe) { view.point = point; magnify(); }
  };
  let held = null;
  stage.addEventListener("pointerdown", (event) => {
    if (event.button) return;
    const { share, at } = under(event), movable = stage.classList.contains("movable");
    const near = (Math.abs(share - view.split) * panes[0].clientWidth) / 100 < 24;
    held = stage.dataset.mode === "swipe" && (near || !movable) ? "split" : movable ? [event.clientX, event.clientY] : null;
    if (held) stage.setPointerCapture(event.pointerId);
    if (held === "split") split(share);
    look(at);
  });
  stage.addEventListener("pointermove", (event) => {
    // A captured pointer is the stage's: the pane is told from where it is.
    const { at } = under(event);
    if (held === "split") {
      const box = panes[0].getBoundingClientRect();
      split((100 * (event.clientX - box.left)) / box.width);
    } else if (held) {
      const s = scale();
      [view.x, view.y] = [view.x - (event.clientX - held[0]) / s, view.y - (event.clientY - held[1]) / s];
      held = [event.clientX, event.clientY];
      layout();
    } else look(at);
  });
  for (const name of ["pointerup", "pointercancel"]) stage.addEventListener(name, () => { held = null; });
  stage.addEventListener("dblclick", (event) => { if (stage.dataset.mode !== "swipe") nearer(1, under(event).at); });
  stage.addEventListener("wheel", (event) => {
    if (!event.ctrlKey && !event.metaKey) return;
    event.preventDefault();
    zoom(clamp(scale() * Math.exp(-event.deltaY / 180), fit(), 24), under(event).at);
  }, { passive: false });

  for (const button of all(".modes button", host)) button.addEventListener("click", () => mode(button.dataset.mode));
  one("#_split").addEventListener("input", (event) => split(Number(event.target.value)));
  one("#_gain").addEventListener("input", (event) => gain(Number(event.target.value)));
  one("#_pause").addEventListener("click", () => space());
  for (const what of ["boxes", "loupe"]) one(`#_${what}`).addEventListener("click", () => toggle(what));
  one("#_in").addEventListener("click", () => nearer(1));
  one("#_out").addEventListener("click", () => nearer(-1));
  const space = () => {
    if (running()) run(false);
    else blink();
  };
  new ResizeObserver(layout).observe(stage);

  return {
    show, mode, place, go, move, nearer, toggle, space,
    get at() { return view.place; },
    get blinks() { return stage.dataset.mode === "blink"; },
    get zoomed() { return view.scale !== null; },
    stage,
    choose: (number) => { if (available.includes(MODES[number])) mode(MODES[number]); },
    split: (by) => split(view.split + by),
    gain: (by) => gain(view.gain + by),
    whole: () => { view.scale = null; layout(); },
  };
})();
