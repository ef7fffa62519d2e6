// Walking: arrow keys or WASD move, E and Q rise and sink, dragging looks about; on a touch screen one finger looks, two walk.

import { Euler, type PerspectiveCamera, Vector3 } from "three";

/** Metres a second, in scenes of the size of rooms; others are crossed in as long. */
const SPEED = 1.6;
/** Times as fast with shift. */
const HURRY = 3;
/** Radians a pixel. */
const TURN = 0.0035;

/** Right, up, back of each key. */
const KEYS: Record<string, [number, number, number]> = {
  KeyW: [0, 0, -1], ArrowUp: [0, 0, -1], KeyS: [0, 0, 1], ArrowDown: [0, 0, 1],
  KeyA: [-1, 0, 0], ArrowLeft: [-1, 0, 0], KeyD: [1, 0, 0], ArrowRight: [1, 0, 0],
  KeyE: [0, 1, 0], PageUp: [0, 1, 0], KeyQ: [0, -1, 0], PageDown: [0, -1, 0],
};

export class Walk {
  enabled = false;
  private readonly pressed = new Set<string>();
  private readonly fingers = new Map<number, { x: number; y: number }>();
  private readonly speed: number;
  private hurry = false;

  constructor(
    private readonly camera: PerspectiveCamera,
    canvas: HTMLCanvasElement,
    radius: number,
    private readonly changed: () => void,
  ) {
    // A room of 5 m is crossed at walking pace, and so is a model of 5 mm.
    this.speed = SPEED * Math.min(Math.max(radius / 4, 0.25 * Math.min(radius, 1)), 20);
    canvas.addEventListener("pointerdown", (event) => this.fingers.set(event.pointerId, { x: event.clientX, y: event.clientY }));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const end of ["pointerup", "pointercancel"] as const) {
      canvas.addEventListener(end, (event) => this.fingers.delete(event.pointerId));
    }
    window.addEventListener("keydown", (event) => this.press(event));
    window.addEventListener("keyup", (event) => {
      this.pressed.delete(event.code);
      this.hurry = event.shiftKey;
    });
    window.addEventListener("blur", () => this.pressed.clear());
  }

  /** Whether a key is pressed that moves. */
  step(seconds: number): boolean {
    if (!this.enabled || this.pressed.size === 0) return false;
    const way = new Vector3();
    for (const key of this.pressed) way.add(new Vector3(...KEYS[key]!));
    this.go(way.multiplyScalar(this.speed * seconds * (this.hurry ? HURRY : 1)));
    return true;
  }

  /** Goes right, up and back, with both feet on a level floor. */
  private go(way: Vector3): void {
    const { y } = new Euler().setFromQuaternion(this.camera.quaternion, "YXZ");
    this.camera.position.add(way.applyEuler(new Euler(0, y, 0)));
    this.changed();
  }

  private press(event: KeyboardEvent): void {
    this.hurry = event.shiftKey;
    const typing = event.target instanceof HTMLInputElement || event.target instanceof HTMLSelectElement;
    if (!this.enabled || typing || event.ctrlKey || event.metaKey || event.altKey || !(event.code in KEYS)) return;
    event.preventDefault();
    this.pressed.add(event.code);
    this.changed();
  }

  private move(event: PointerEvent): void {
    const last = this.fingers.get(event.pointerId);
    if (!last) return;
    const [x, y] = [event.clientX - last.x, event.clientY - last.y];
    this.fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (!this.enabled) return;
    if (this.fingers.size > 1) {
      // Both fingers tell of the same way.
      this.go(new Vector3(-x, 0, -y).multiplyScalar(0.005 * this.speed / this.fingers.size));
      return;
    }
    const turn = new Euler().setFromQuaternion(this.camera.quaternion, "YXZ");
    turn.y += TURN * x;
    turn.x = Math.min(Math.max(turn.x + TURN * y, -1.5), 1.5);
    turn.z = 0;
    this.camera.quaternion.setFromEuler(turn);
    this.changed();
  }
}
