// Where one looks from: the cameras of the scene to begin with, then orbiting about a point or walking.

import { MathUtils, PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { CameraHeader, SurfacesHeader } from "./surfaces";
import { Walk } from "./walk";

/** An orthographic camera is shown as one this many times as far away as the scene is large. */
const FAR_AWAY = 100;
/** Shape of a camera that has none. */
const ASPECT = 16 / 9;

export class Camera {
  readonly camera = new PerspectiveCamera();
  private readonly orbit: OrbitControls;
  private readonly walk: Walk;
  private readonly center: Vector3;
  private readonly radius: number;
  private frame: { angle: number; aspect: number } = { angle: 50, aspect: ASPECT };

  /** Moves as the pointer over `canvas` and the keyboard say, and calls `changed` then. */
  constructor(canvas: HTMLCanvasElement, { bounds }: SurfacesHeader, changed: () => void) {
    this.center = new Vector3(...bounds.center);
    this.radius = Math.max(bounds.radius, 1e-6);
    this.orbit = new OrbitControls(this.camera, canvas);
    this.orbit.zoomToCursor = true;
    this.orbit.minDistance = 1e-3 * this.radius;
    this.orbit.maxDistance = 2 * FAR_AWAY * this.radius;
    this.orbit.addEventListener("change", changed);
    this.walk = new Walk(this.camera, canvas, this.radius, changed);
  }

  get isWalking(): boolean {
    return this.walk.enabled;
  }

  /** Walks from now on, or orbits about `target`. */
  setWalking(walking: boolean, target: Vector3): void {
    this.walk.enabled = walking;
    this.orbit.enabled = !walking;
    if (!walking) this.orbitAbout(target);
  }

  /** Orbits about `target` from now on; the view stays as it is until somebody moves. */
  orbitAbout(target: Vector3): void {
    const ahead = new Vector3();
    this.camera.getWorldDirection(ahead);
    // The controls look at their target at once, so it must lie ahead.
    const distance = Math.max(target.clone().sub(this.camera.position).dot(ahead), 1e-2 * this.radius);
    this.orbit.target.copy(this.camera.position).addScaledVector(ahead, distance);
  }

  /** Looks at `target`, and orbits about it. */
  lookAt(target: Vector3): void {
    this.orbit.target.copy(target);
    this.orbit.update();
  }

  /** Takes the place of a camera of the scene. */
  take({ position, forward, up, vertical_angle, height, aspect }: CameraHeader): void {
    const ahead = new Vector3(...forward);
    this.camera.position.set(...position);
    this.camera.up.set(...up);
    this.camera.lookAt(this.camera.position.clone().add(ahead));
    this.camera.up.set(0, 1, 0);
    this.frame = { angle: MathUtils.radToDeg(vertical_angle ?? 0), aspect: aspect ?? ASPECT };
    if (height !== null) {
      const distance = FAR_AWAY * this.radius;
      this.frame.angle = 2 * MathUtils.radToDeg(Math.atan(height / 2 / distance));
      this.camera.position.addScaledVector(ahead, -distance);
    }
    this.camera.updateMatrixWorld();
  }

  /** One step of walking of so many seconds; whether that moved anything. */
  step(seconds: number): boolean {
    return this.walk.step(seconds);
  }

  /** Fits the picture into so many pixels: all that the scene's camera shows stays in sight. */
  fit(width: number, height: number): void {
    const { angle, aspect } = this.frame;
    const half = Math.tan(MathUtils.degToRad(angle) / 2);
    const narrow = Math.max(1, Math.min(aspect, ASPECT) / (width / height));
    // On a phone held upright a wide room is cut at the sides rather than seen through a fish eye.
    this.camera.fov = 2 * MathUtils.radToDeg(Math.atan(half * Math.min(narrow, 1.6)));
    this.camera.aspect = width / height;
    const distance = this.camera.position.distanceTo(this.center);
    this.camera.far = distance + 1.01 * this.radius;
    this.camera.near = Math.max(distance - 1.01 * this.radius, 5e-4 * this.radius, 1e-5 * this.camera.far);
    this.camera.updateProjectionMatrix();
  }
}
