// @ts-check
/** What a message is made of, each value with the way that leads to it, and how values are read. */

const MOST = 16; // of an array
const LONGEST = 160; // of a text

/** @typedef {(string | number)[]} Way */

/**
 * @param {any} value
 * @param {Way} [way]
 * @returns {Generator<[Way, any]>} each value that has no parts, in order; of a long array the first
 */
export function* fields(value, way = []) {
  if (Array.isArray(value)) {
    for (let at = 0; at < Math.min(value.length, MOST); at += 1) yield* fields(value[at], [...way, at]);
    if (value.length > MOST) yield [[...way, "\u2026"], `${value.length - MOST} more`];
    if (!value.length) yield [way, "[]"];
  } else if (value && typeof value === "object") {
    for (const [name, part] of Object.entries(value)) yield* fields(part, [...way, name]);
  } else yield [way, value];
}

/**
 * @param {Way} way
 * @returns {string} it as one types it, such as pulses[0].duty_ticks
 */
export function typed(way) {
  return way.map((part, at) => (typeof part === "number" ? `[${part}]` : (at ? "." : "") + part)).join("");
}

/**
 * @param {any} message
 * @param {Way} way
 * @returns {number | null} the number there; null where there is none
 */
export function number(message, way) {
  let value = message;
  for (const part of way) value = value === null || value === undefined ? undefined : value[part];
  if (typeof value === "boolean") return Number(value);
  return typeof value === "number" && Number.isFinite(value) ? value : null;
}

/**
 * @param {any} value
 * @returns {string} it as a person reads it
 */
export function worded(value) {
  if (typeof value === "number") return Number.isInteger(value) ? String(value) : value.toPrecision(6).replace(/\.?0+$/, "");
  const text = String(value);
  return text.length > LONGEST ? `${text.slice(0, LONGEST)}\u2026` : text;
}

/**
 * @param {number} hz
 * @returns {string} how often something is said, as a person reads it
 */
export function rate(hz) {
  if (!hz) return "";
  return hz >= 10 ? `${Math.round(hz)}/s` : `${hz.toFixed(1)}/s`;
}
