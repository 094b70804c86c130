// @ts-check
/** The robot from above, in the frame of its odometry: where it is, which way it looks, where it came from. */

const TRAIL = 1500; // poses
const MOVED = 0.01; // m between two of them
const MARGIN = 1.5; // m around the robot that are shown at least
const GRID = [0.1, 0.25, 0.5, 1, 2, 5, 10, 25, 50]; // m between two lines

export class Top {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    /** @type {[number, number][]} */
    this.trail = [];
    this.pose = { x: 0, y: 0, heading: 0 };
    this.known = false;
    this.vehicle = { steers: true, length: 0.25, width: 0.17 };
    this.wheels = 0; // rad, to the left
    /** @type {{points: [number, number][], closed: boolean}[]} */
    this.scene = [];
    this.due = false;
    new ResizeObserver(() => this.ask()).observe(canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.ask());
  }

  /** @param {any} odom nav_msgs/msg/Odometry */
  move(odom) {
    const { position, orientation } = odom.pose.pose;
    const heading = 2 * Math.atan2(orientation.z, orientation.w);
    const last = this.trail[this.trail.length - 1];
    const way = last ? Math.hypot(position.x - last[0], position.y - last[1]) : Infinity;
    if (way > 10 * MARGIN && last) this.trail = []; // counted anew
    if (way > MOVED) this.trail.push([position.x, position.y]);
    if (this.trail.length > TRAIL) this.trail.splice(0, this.trail.length - TRAIL);
    this.pose = { x: position.x, y: position.y, heading };
    this.known = true;
    this.ask();
  }

  /** Draw soon, once, however often that is asked. */
  ask() {
    if (this.due) return;
    this.due = true;
    requestAnimationFrame(() => {
      this.due = false;
      this.draw();
    });
  }

  draw() {
    const { canvas } = this;
    const scale = devicePixelRatio || 1;
    const [wide, high] = [canvas.clientWidth, canvas.clientHeight];
    if (!wide || !high) return;
    if (canvas.width !== Math.round(wide * scale) || canvas.height !== Math.round(high * scale)) {
      canvas.width = Math.round(wide * scale);
      canvas.height = Math.round(high * scale);
    }
    const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
    const style = getComputedStyle(canvas);
    /** @param {string} name */
    const ink = (name) => style.getPropertyValue(name).trim();
    pen.setTransform(scale, 0, 0, scale, 0, 0);
    pen.clearRect(0, 0, wide, high);
    const [x, y, reach] = this.frame();
    const zoom = Math.min(wide, high) / (2 * reach);
    pen.translate(wide / 2, high / 2);
    pen.scale(zoom, -zoom);
    pen.translate(-x, -y);
    const hair = 1 / zoom;
    this.drawGrid(pen, hair, [ink("--line"), ink("--faint")], [x, y], [wide / zoom / 2, high / zoom / 2]);
    pen.lineWidth = 2 * hair;
    pen.strokeStyle = ink("--faint");
    for (const { points, closed } of this.scene) line(pen, points, closed);
    pen.strokeStyle = ink("--good");
    pen.lineWidth = 2.5 * hair;
    line(pen, this.trail, false);
    if (this.known) this.drawRobot(pen, zoom, ink("--ink"), ink("--plate"));
  }

  /** @returns {[number, number, number]} the middle of what is shown, and how far it reaches, m */
  frame() {
    const { x, y } = this.pose;
    let reach = MARGIN;
    for (const [tx, ty] of this.trail.slice(-400)) reach = Math.max(reach, 1.15 * Math.max(Math.abs(tx - x), Math.abs(ty - y)));
    return [x, y, Math.min(reach, 12)];
  }

  /**
   * @param {CanvasRenderingContext2D} pen
   * @param {number} hair
   * @param {[string, string]} inks of the lines, and of their measure
   * @param {[number, number]} middle
   * @param {[number, number]} half
   */
  drawGrid(pen, hair, [ink, faint], [x, y], [wide, high]) {
    const step = GRID.find((one) => one / hair > 48) || 100;
    pen.strokeStyle = ink;
    pen.lineWidth = hair;
    pen.beginPath();
    for (let at = Math.ceil((x - wide) / step) * step; at <= x + wide; at += step) {
      pen.moveTo(at, y - high);
      pen.lineTo(at, y + high);
    }
    for (let at = Math.ceil((y - high) / step) * step; at <= y + high; at += step) {
      pen.moveTo(x - wide, at);
      pen.lineTo(x + wide, at);
    }
    pen.stroke();
    pen.save();
    pen.setTransform(devicePixelRatio || 1, 0, 0, devicePixelRatio || 1, 0, 0);
    pen.fillStyle = faint;
    pen.font = "12px system-ui, sans-serif";
    pen.fillText(`a square is ${step} m`, 8, this.canvas.clientHeight - 8);
    pen.restore();
  }

  /**
   * @param {CanvasRenderingContext2D} pen
   * @param {number} zoom
   * @param {string} ink
   * @param {string} plate
   */
  drawRobot(pen, zoom, ink, plate) {
    const { length, width, steers } = this.vehicle;
    const larger = Math.max(1, 28 / (length * zoom)); // of a far robot at least something is seen
    pen.save();
    pen.translate(this.pose.x, this.pose.y);
    pen.rotate(this.pose.heading);
    pen.scale(larger, larger);
    const hair = 2 / zoom / larger;
    pen.lineWidth = hair;
    pen.strokeStyle = ink;
    pen.fillStyle = plate;
    pen.beginPath();
    if (steers) /** @type {any} */ (pen).roundRect(-0.3 * length, -width / 2, 1.6 * length, width, 0.2 * width);
    else pen.arc(0, 0, length / 2, 0, 2 * Math.PI);
    pen.fill();
    pen.stroke();
    pen.fillStyle = ink;
    const [long, thick] = [0.35 * length, 0.16 * width];
    for (const side of [-1, 1]) {
      pen.fillRect(-long / 2, (side * width) / 2 - thick / 2, long, thick);
      if (!steers) continue;
      pen.save();
      pen.translate(length, (side * width) / 2);
      pen.rotate(this.wheels);
      pen.fillRect(-long / 2, -thick / 2, long, thick);
      pen.restore();
    }
    pen.beginPath();
    const nose = steers ? 1.1 * length : 0.35 * length;
    pen.moveTo(nose, 0);
    pen.lineTo(nose - 0.3 * length, 0.25 * width);
    pen.lineTo(nose - 0.3 * length, -0.25 * width);
    pen.fill();
    pen.restore();
  }
}

/**
 * @param {CanvasRenderingContext2D} pen
 * @param {[number, number][]} points
 * @param {boolean} closed
 */
function line(pen, points, closed) {
  if (points.length < 2) return;
  pen.beginPath();
  points.forEach(([x, y], at) => (at ? pen.lineTo(x, y) : pen.moveTo(x, y)));
  if (closed) pen.closePath();
  pen.stroke();
}
