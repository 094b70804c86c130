// @ts-check
/** All robots on the bus: a row for each, with what it does and who operates it. */

/** @typedef {{name: string, state: string, why: string, operator: string}} Robot */

/**
 * @param {HTMLElement} place
 * @param {Robot[]} robots
 * @param {string} own the one that this page drives
 */
export function show(place, robots, own) {
  const table = document.createElement("table");
  const head = table.createTHead().insertRow();
  for (const title of ["robot", "does", "operated by", "why"]) {
    const cell = document.createElement("th");
    cell.scope = "col";
    cell.textContent = title;
    head.append(cell);
  }
  const rows = table.createTBody();
  for (const { name, state, why, operator } of robots) {
    const row = rows.insertRow();
    row.dataset.state = state;
    for (const text of [name === own ? `${name} (this one)` : name, state, operator || "nobody", why]) row.insertCell().textContent = text;
  }
  place.replaceChildren(table);
}
