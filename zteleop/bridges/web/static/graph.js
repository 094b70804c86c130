// @ts-check
/** Nodes and topics as a drawing: who says what on the left, who hears it on the right, rates on the arrows. */

import { rate } from "./fields.js";

const SVG = "http://www.w3.org/2000/svg";
const ROW = 30; // px a topic
const [WIDE, TOPIC, NODE] = [760, 210, 130]; // px
const EDGE = 14; // px around it all

/** @typedef {import("./topics.js").Topic} Topic */

/**
 * @param {string} kind
 * @param {Record<string, string | number>} about
 * @param {string} [text]
 */
function part(kind, about, text) {
  const made = document.createElementNS(SVG, kind);
  for (const [name, value] of Object.entries(about)) made.setAttribute(name, String(value));
  if (text !== undefined) made.textContent = text;
  return made;
}

/**
 * @param {string[]} names some of them more than once
 * @returns {Map<string, number>} how often each is there
 */
function counted(names) {
  const found = new Map();
  for (const name of names) found.set(name, (found.get(name) || 0) + 1);
  return found;
}

/**
 * Where each node stands: beside the middle of its topics, and none above another.
 * @param {Topic[]} topics
 * @param {"said_by" | "heard_by"} side
 * @returns {Map<string, number>} node -> y
 */
export function places(topics, side) {
  /** @type {Map<string, number[]>} */
  const rows = new Map();
  topics.forEach((topic, at) => {
    for (const name of new Set(topic[side])) rows.set(name, [...(rows.get(name) || []), at]);
  });
  /** @param {number[]} at */
  const middle = (at) => at.reduce((sum, one) => sum + one, 0) / at.length;
  const ordered = [...rows].sort((a, b) => middle(a[1]) - middle(b[1]));
  const high = topics.length * ROW;
  const found = new Map();
  ordered.forEach(([name], at) => found.set(name, ((at + 0.5) * high) / ordered.length));
  return found;
}

export class Graph {
  /**
   * @param {SVGElement} drawing
   * @param {(topic: string) => void} choose
   */
  constructor(drawing, choose) {
    this.drawing = drawing;
    this.choose = choose;
    this.made = "";
    /** @type {Map<string, Element[]>} topic -> where its rate stands, and its arrows */
    this.rates = new Map();
  }

  /** @param {Topic[]} topics */
  tell(topics) {
    const shown = topics.filter((topic) => topic.said_by.length || topic.heard_by.length);
    const made = JSON.stringify(shown.map((topic) => [topic.name, topic.said_by, topic.heard_by]));
    if (made !== this.made) this.build(shown);
    this.made = made;
    for (const topic of shown) {
      const [word, ...arrows] = this.rates.get(topic.name) || [];
      if (word) word.textContent = rate(topic.hz);
      for (const arrow of arrows) arrow.classList.toggle("alive", topic.hz > 0);
    }
  }

  /** @param {Topic[]} topics */
  build(topics) {
    this.rates.clear();
    const high = topics.length * ROW;
    this.drawing.setAttribute("viewBox", `0 0 ${WIDE} ${high + 2 * EDGE}`);
    const [left, right] = [places(topics, "said_by"), places(topics, "heard_by")];
    const all = part("g", { transform: `translate(0 ${EDGE})` });
    const head = part("marker", { id: "head", viewBox: "0 0 6 6", refX: 6, refY: 3, markerWidth: 6, markerHeight: 6, orient: "auto" });
    head.append(part("path", { d: "M 0 0 L 6 3 L 0 6 z" }));
    all.append(head);
    const x = (WIDE - TOPIC) / 2;
    topics.forEach((topic, at) => {
      const y = (at + 0.5) * ROW;
      const arrows = [
        ...[...counted(topic.said_by).keys()].map((node) => arrow(EDGE + NODE, left.get(node) || 0, x, y)),
        ...[...counted(topic.heard_by).keys()].map((node) => arrow(x + TOPIC, y, WIDE - EDGE - NODE, right.get(node) || 0)),
      ];
      const word = part("text", { x: x - 8, y: y - 4, class: "rate", "text-anchor": "end" });
      const box = part("g", { class: "topic", role: "button", tabindex: 0 });
      box.append(part("rect", { x, y: y - 11, width: TOPIC, height: 22, rx: 4 }), part("text", { x: x + TOPIC / 2, y: y + 4, "text-anchor": "middle" }, topic.name));
      box.append(part("title", {}, `${topic.name}: ${topic.types.join(", ") || "any type"}`));
      box.addEventListener("click", () => this.choose(topic.name));
      box.addEventListener("keydown", (event) => /** @type {KeyboardEvent} */ (event).key === "Enter" && this.choose(topic.name));
      for (const [event, on] of /** @type {[string, boolean][]} */ ([["pointerenter", true], ["pointerleave", false], ["focus", true], ["blur", false]]))
        box.addEventListener(event, () => arrows.forEach((one) => one.classList.toggle("shown", on)));
      all.append(...arrows, word, box);
      this.rates.set(topic.name, [word, ...arrows]);
    });
    for (const [found, at, side] of /** @type {[Map<string, number>, number, "said_by" | "heard_by"][]} */ ([[left, EDGE, "said_by"], [right, WIDE - EDGE - NODE, "heard_by"]]))
      for (const [name, y] of found) {
        const times = Math.max(...topics.map((topic) => counted(topic[side]).get(name) || 0));
        const node = part("g", { class: "node" });
        node.append(part("rect", { x: at, y: y - 13, width: NODE, height: 26, rx: 13 }));
        node.append(part("text", { x: at + NODE / 2, y: y + 4, "text-anchor": "middle" }, times > 1 ? `${name} \u00d7${times}` : name));
        all.append(node);
      }
    this.drawing.replaceChildren(all);
  }
}

/**
 * @param {number} x
 * @param {number} y
 * @param {number} toX
 * @param {number} toY
 */
function arrow(x, y, toX, toY) {
  const bend = (toX - x) / 2;
  return part("path", { class: "arrow", "marker-end": "url(#head)", d: `M ${x} ${y} C ${x + bend} ${y}, ${toX - bend} ${toY}, ${toX} ${toY}` });
}
