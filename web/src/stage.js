/**
 * Renderer, camera, light and the loop that draws only what changed.
 */
import {
  DirectionalLight,
  Group,
  HemisphereLight,
  PerspectiveCamera,
  Scene,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

const FLIGHT_MS = 650;
const FIELD_DEG = 32;
const SHARE_FILLED = 0.86; // of the picture, by the whole part

export class Stage {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {import("./page.js").View} view
   */
  constructor(canvas, view) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, stencil: true });
    this.renderer.localClippingEnabled = true;
    this.scene = new Scene();
    /** Leans with the bed. */
    this.bed = new Group();
    /** Falls on the bed. */
    this.part = new Group();
    this.bed.add(this.part);
    this.scene.add(this.bed);
    this.camera = new PerspectiveCamera(FIELD_DEG, 1, 1, 1000);
    this.camera.up.set(0, 0, 1);
    this.scene.add(this.camera);
    this.#light();
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.addEventListener("change", () => this.draw());
    /** @type {(() => void)[]} called before every picture */
    this.beforeDraw = [];
    this.low = new Vector3();
    this.high = new Vector3();
    this.middle = new Vector3();
    this.size = 1; // of the diagonal, mm
    this.frame(view);
    this.#wanted = false;
    this.#flight = 0;
    new ResizeObserver(() => this.resize()).observe(
      /** @type {HTMLElement} */ (canvas.parentElement),
    );
    this.resize();
  }

  #wanted;
  #flight;

  #light() {
    this.scene.add(new HemisphereLight("#ffffff", "#8d8a99", 1.55));
    const key = new DirectionalLight("#fff4e6", 1.9);
    key.position.set(-0.7, 0.9, 0.8); // beside the eye, so that shapes are always lit
    const fill = new DirectionalLight("#dfe9ff", 0.6);
    fill.position.set(0.9, -0.2, 0.5);
    this.camera.add(key, fill);
    this.camera.add(key.target, fill.target);
    key.target.position.set(0, 0, -1);
    fill.target.position.set(0, 0, -1);
  }

  /** @param {import("./page.js").View} view */
  frame(view) {
    this.low.fromArray(view.low);
    this.high.fromArray(view.high);
    this.size = this.high.distanceTo(this.low) || 1;
    this.middle.addVectors(this.low, this.high).multiplyScalar(0.5);
    this.camera.near = this.size / 200;
    this.camera.far = this.size * 30;
    this.controls.minDistance = this.size / 20;
    this.controls.maxDistance = this.size * 8;
    this.camera.updateProjectionMatrix();
  }

  resize() {
    const box = /** @type {HTMLElement} */ (this.canvas.parentElement).getBoundingClientRect();
    const width = Math.max(1, Math.round(box.width));
    const height = Math.max(1, Math.round(box.height));
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.now();
  }

  /** Draws soon; many wishes make one picture. */
  draw() {
    if (!this.#wanted) {
      this.#wanted = true;
      requestAnimationFrame(() => this.now());
    }
  }

  now() {
    this.#wanted = false;
    this.scene.updateMatrixWorld();
    for (const prepare of this.beforeDraw) {
      prepare();
    }
    this.renderer.render(this.scene, this.camera);
  }

  /**
   * The distance from the middle at which the whole part is seen.
   * @param {Vector3} from unit vector from the part to the eye
   */
  fitDistance(from) {
    const up = Math.tan((FIELD_DEG * Math.PI) / 360) * SHARE_FILLED;
    const across = up * this.camera.aspect;
    const right = new Vector3().crossVectors(this.camera.up, from).normalize();
    const upward = new Vector3().crossVectors(from, right);
    let distance = 0;
    for (const x of [this.low.x, this.high.x]) {
      for (const y of [this.low.y, this.high.y]) {
        for (const z of [this.low.z, this.high.z]) {
          const corner = new Vector3(x, y, z).sub(this.middle);
          const near = corner.dot(from);
          const needed = Math.max(
            Math.abs(corner.dot(right)) / across,
            Math.abs(corner.dot(upward)) / up,
          );
          distance = Math.max(distance, near + needed);
        }
      }
    }
    return distance;
  }

  /**
   * Looks at the whole part.
   * @param {Vector3} from direction from the part to the eye
   * @param {boolean} at_once
   */
  look(from, at_once = false) {
    const away = from.clone().normalize();
    const eye = this.middle.clone().addScaledVector(away, this.fitDistance(away));
    this.fly(eye, this.middle, at_once);
  }

  /**
   * Moves the eye.
   * @param {Vector3} eye
   * @param {Vector3} target
   * @param {boolean} at_once
   */
  fly(eye, target, at_once = false) {
    cancelAnimationFrame(this.#flight);
    const [eye0, target0] = [this.camera.position.clone(), this.controls.target.clone()];
    const start = performance.now();
    this.canvas.dataset.moving = "true";
    const still = at_once || matchMedia("(prefers-reduced-motion: reduce)").matches;
    /** @param {number} now */
    const step = (now) => {
      const share = still ? 1 : Math.min((now - start) / FLIGHT_MS, 1);
      const eased = share * share * (3 - 2 * share);
      this.controls.target.lerpVectors(target0, target, eased);
      this.camera.position.lerpVectors(eye0, eye, eased);
      this.controls.update();
      this.now();
      if (share < 1) {
        this.#flight = requestAnimationFrame(step);
      } else {
        delete this.canvas.dataset.moving;
      }
    };
    step(start);
  }

  /**
   * Where a place in the world is in the viewer, in CSS pixels; behind the eye: null.
   * @param {Vector3} place
   */
  project(place) {
    const seen = place.clone().project(this.camera);
    if (seen.z > 1) {
      return null;
    }
    const box = this.canvas.getBoundingClientRect();
    return { x: ((seen.x + 1) / 2) * box.width, y: ((1 - seen.y) / 2) * box.height };
  }
}
