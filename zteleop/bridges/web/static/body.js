// @ts-check
/** What a robot feels: dangers, and which of its buttons are down, in words. */

const DANGERS = ["backup limit", "bump", "cliff", "stall", "wheel drop", "object near"]; // of irobot_create_msgs

/**
 * @param {any} said irobot_create_msgs/msg/HazardDetectionVector
 * @returns {string}
 */
export function dangers(said) {
  const found = said.detections.map((/** @type {any} */ one) => {
    const danger = DANGERS[one.type] || `hazard ${one.type}`;
    const where = one.header.frame_id.replaceAll("_", " ").replace(danger, "").trim();
    return [danger, where].filter(Boolean).join(" ");
  });
  return [...new Set(found)].join(", ") || "none";
}

/**
 * @param {any} said irobot_create_msgs/msg/InterfaceButtons
 * @returns {string}
 */
export function buttons(said) {
  const down = Object.entries(said).filter(([, button]) => button && button.is_pressed);
  return down.map(([name]) => name.replaceAll("_", " ")).join(", ") || "none is down";
}
