// What browser.py measures in a page. Each function gives a list of problems, as sentences.

const TOLERANCE = 1; // px

function name(element) {
  const text = element.textContent.trim().replace(/\s+/g, " ").slice(0, 40);
  const id = element.id ? `#${element.id}` : "";
  return `<${element.tagName.toLowerCase()}${id}>${text ? ` “${text}”` : ""}`;
}

function shown(element) {
  if (!element.checkVisibility({ opacityProperty: true, visibilityProperty: true })) return false;
  // Inside a drawing, browsers count what is not displayed as visible.
  for (let above = element; above?.ownerSVGElement; above = above.parentElement) {
    if (getComputedStyle(above).display === "none") return false;
  }
  return true;
}

function figures(wanted) {
  const all = [...document.querySelectorAll("figure")];
  if (all.length === 0) return ["no figure in the page"];
  const missing = wanted.filter((id) => !document.getElementById(`figure-${id}`));
  if (missing.length > 0) return missing.map((id) => `the figure ${id} is not in the page`);
  const empty = all.filter((figure) => {
    const drawings = [...figure.querySelectorAll("svg")].map((svg) => svg.getBoundingClientRect());
    return !drawings.some((box) => box.width > 0 && box.height > 0);
  });
  return empty.map((figure) => `${name(figure)} has no drawing of any size`);
}

function overflow() {
  const limit = window.innerWidth;
  const root = document.documentElement;
  const wide = Math.max(root.scrollWidth, document.body.scrollWidth);
  // What scrolls inside a box of its own does not make the page wider.
  const scrolls = (element) => {
    for (let above = element.parentElement; above && above !== document.body; above = above.parentElement) {
      if (["auto", "scroll", "hidden", "clip"].includes(getComputedStyle(above).overflowX)) return true;
    }
    return false;
  };
  const outside = [...document.body.querySelectorAll("*")].filter((element) => {
    if (element.ownerSVGElement || !shown(element) || scrolls(element)) return false;
    const box = element.getBoundingClientRect();
    return box.width > 0 && (box.right > limit + TOLERANCE || box.left < -TOLERANCE);
  });
  const problems = outside.map((element) => `${name(element)} reaches from ${Math.round(element.getBoundingClientRect().left)} to ${Math.round(element.getBoundingClientRect().right)} px`);
  if (wide > limit) problems.unshift(`the page is ${wide} px wide in a window of ${limit} px`);
  return problems;
}

// Corners of a text as seen on the screen, turned with it. The box of a font is taller than its letters: a strip above and below is left out.
function corners(text) {
  const box = text.getBBox();
  const matrix = text.getScreenCTM();
  const size = Number.parseFloat(getComputedStyle(text).fontSize);
  const [top, bottom] = [box.y + 0.15 * size, box.y + box.height - 0.1 * size];
  const at = (x, y) => {
    const point = new DOMPoint(x, y).matrixTransform(matrix);
    return [point.x, point.y];
  };
  return [at(box.x, top), at(box.x + box.width, top), at(box.x + box.width, bottom), at(box.x, bottom)];
}

function drawings() {
  return [...document.querySelectorAll("svg")].filter((svg) => !svg.ownerSVGElement && shown(svg)).map((svg) => {
    const texts = [...svg.querySelectorAll("text")].filter((text) => shown(text) && text.textContent.trim() && text.getBBox().width > 0);
    return { svg, texts };
  });
}

function textsOutside() {
  const problems = [];
  for (const { svg, texts } of drawings()) {
    const box = svg.getBoundingClientRect();
    for (const text of texts) {
      const out = corners(text).map(([x, y]) => Math.max(box.left - x, x - box.right, box.top - y, y - box.bottom));
      if (Math.max(...out) > TOLERANCE) problems.push(`${name(text)} reaches ${Math.max(...out).toFixed(1)} px out of its drawing`);
    }
  }
  return problems;
}

// By how much two convex quadrilaterals overlap: the smallest overlap in the directions of their sides.
function depth(a, b) {
  let smallest = Infinity;
  for (const quad of [a, b]) {
    for (const side of [0, 1]) {
      const [x, y] = [quad[side + 1][0] - quad[side][0], quad[side + 1][1] - quad[side][1]];
      const length = Math.hypot(x, y);
      if (length === 0) return 0;
      const along = (point) => (-point[0] * y + point[1] * x) / length;
      const [p, q] = [a.map(along), b.map(along)];
      smallest = Math.min(smallest, Math.max(...p) - Math.min(...q), Math.max(...q) - Math.min(...p));
    }
  }
  return smallest;
}

// A text drawn twice in one place: the lower one is the halo that keeps the upper one legible over lines.
function isHalo(a, b, quadA, quadB) {
  return a.textContent === b.textContent && quadA.every(([x, y], i) => Math.hypot(x - quadB[i][0], y - quadB[i][1]) <= TOLERANCE);
}

function textsOverlapping() {
  const problems = [];
  for (const { texts } of drawings()) {
    const quads = texts.map(corners);
    for (let i = 0; i < texts.length; i += 1) {
      for (let j = i + 1; j < texts.length; j += 1) {
        if (isHalo(texts[i], texts[j], quads[i], quads[j])) continue;
        const overlap = depth(quads[i], quads[j]);
        if (overlap > TOLERANCE) problems.push(`${name(texts[i])} and ${name(texts[j])} overlap by ${overlap.toFixed(1)} px`);
      }
    }
  }
  return problems;
}

// Each button of a film shows its frame and no other, and the texts of that frame keep apart.
function frames() {
  const problems = [];
  for (const film of document.querySelectorAll("fieldset.film")) {
    const buttons = [...film.querySelectorAll("input")];
    const all = [...film.querySelectorAll("svg > g.k")];
    const first = buttons.find((button) => button.checked);
    if (!first || buttons.length !== all.length) problems.push(`${name(film)} has ${all.length} frames and ${buttons.length} buttons`);
    if (!film.querySelector("legend")?.textContent.trim()) problems.push(`${name(film)} has no legend`);
    const { width, height } = film.querySelector("svg").getBoundingClientRect();
    buttons.forEach((button, i) => {
      button.click();
      const seen = all.filter((frame) => shown(frame));
      if (seen.length !== 1 || seen[0] !== all[i]) problems.push(`button ${i} of ${name(film)} shows ${seen.length} frames`);
      if (!film.querySelector(`label[for="${button.id}"]`)?.textContent.trim()) problems.push(`button ${i} of ${name(film)} has no label`);
      const box = film.querySelector("svg").getBoundingClientRect();
      if (box.width !== width || box.height !== height) problems.push(`frame ${i} of ${name(film)} has another size`);
      problems.push(...textsOutside(), ...textsOverlapping());
    });
    first?.click();
  }
  return [...new Set(problems)];
}

const canvas = Object.assign(document.createElement("canvas"), { width: 1, height: 1 });
const context = canvas.getContext("2d", { willReadFrequently: true });
const colours = new Map();

// Any colour that CSS can write, as red, green, blue (0 to 255) and opacity (0 to 1).
function colour(text) {
  if (!colours.has(text)) {
    context.clearRect(0, 0, 1, 1);
    context.fillStyle = text;
    context.fillRect(0, 0, 1, 1);
    const [r, g, b, a] = context.getImageData(0, 0, 1, 1).data;
    colours.set(text, [r, g, b, a / 255]);
  }
  return colours.get(text);
}

function over(top, bottom) {
  const alpha = top[3] + bottom[3] * (1 - top[3]);
  if (alpha === 0) return [0, 0, 0, 0];
  return [...[0, 1, 2].map((i) => (top[i] * top[3] + bottom[i] * bottom[3] * (1 - top[3])) / alpha), alpha];
}

function opacity(element) {
  let product = 1;
  for (let above = element; above; above = above.parentElement) product *= Number(getComputedStyle(above).opacity);
  return product;
}

function faded([r, g, b, a], factor) {
  return [r, g, b, a * factor];
}

// What a shape or a box paints at a point of the window; null for something that is not one colour.
function paint(element, x, y) {
  const style = getComputedStyle(element);
  if (element.ownerSVGElement) {
    if (!element.isPointInFill || style.fill === "none") return [0, 0, 0, 0];
    const point = new DOMPoint(x, y).matrixTransform(element.getScreenCTM().inverse());
    if (!element.isPointInFill(point)) return [0, 0, 0, 0];
    if (style.fill.startsWith("url")) return null;
    return faded(colour(style.fill), Number(style.fillOpacity) * opacity(element));
  }
  if (style.backgroundImage !== "none") return null;
  return faded(colour(style.backgroundColor), opacity(element));
}

function luminance(rgb) {
  const [r, g, b] = rgb.slice(0, 3).map((value) => {
    const part = value / 255;
    return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

function ratio(a, b) {
  const [dark, light] = [luminance(a), luminance(b)].sort((p, q) => p - q);
  return (light + 0.05) / (dark + 0.05);
}

// Everything opaque is found from the top down; below all lies the canvas of the page.
function background(element, x, y) {
  let seen = [0, 0, 0, 0];
  const stack = document.elementsFromPoint(x, y);
  const place = stack.indexOf(element);
  // A text that something covers, or that lies outside the window, cannot be judged.
  if (place < 0) return null;
  const own = element.ownerSVGElement ? place + 1 : place;
  for (const below of stack.slice(own)) {
    if (below.tagName === "text" || below.tagName === "tspan") continue;
    const painted = paint(below, x, y);
    if (painted === null) return null;
    seen = over(seen, painted);
    if (seen[3] > 0.999) return seen;
  }
  const dark = getComputedStyle(document.documentElement).colorScheme.includes("dark") && matchMedia("(prefers-color-scheme: dark)").matches;
  return over(seen, dark ? [18, 18, 18, 1] : [255, 255, 255, 1]);
}

// Visible elements with text of their own, each with a point on that text.
function texts() {
  const found = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const element = node.parentElement;
    if (!node.data.trim() || !shown(element) || element.closest("script, style, noscript, template, title, desc, defs")) continue;
    const range = document.createRange();
    range.selectNodeContents(node);
    const box = [...range.getClientRects()].find((rect) => rect.width > 1 && rect.height > 1);
    if (box) found.push({ element, x: box.left + box.width / 2, y: box.top + box.height / 2 });
  }
  return found;
}

function contrasts(limit) {
  // A point hits what is painted there, whatever the page says about the pointer.
  const sheet = new CSSStyleSheet();
  sheet.replaceSync("* { pointer-events: auto !important } svg * { pointer-events: visiblePainted !important }");
  document.adoptedStyleSheets = [...document.adoptedStyleSheets, sheet];
  window.scrollTo(0, 0);
  const problems = new Set();
  let [judged, unknown] = [0, 0];
  for (const { element, x, y } of texts()) {
    const below = background(element, x, y);
    if (below === null) {
      unknown += 1;
      continue;
    }
    const style = getComputedStyle(element);
    const ink = element.ownerSVGElement ? style.fill : style.color;
    if (ink === "none" || ink.startsWith("url")) continue;
    const fill = element.ownerSVGElement ? Number(style.fillOpacity) : 1;
    const seen = over(faded(colour(ink), fill * opacity(element)), below);
    judged += 1;
    const value = ratio(seen, below);
    if (value < limit) problems.add(`${name(element)} has a contrast of ${value.toFixed(2)}: ${ink} on rgb(${below.slice(0, 3).map(Math.round).join(", ")})`);
  }
  document.adoptedStyleSheets = document.adoptedStyleSheets.filter((known) => known !== sheet);
  return { judged, unknown, problems: [...problems] };
}
