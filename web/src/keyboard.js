/**
 * The picture by keyboard: arrows turn, Shift with arrows moves, + and − come closer and go away.
 */
import { Spherical, Vector3 } from "three";
import { element } from "./page.js";
import { LOOKS } from "./viewer.js";

const TURN = Math.PI / 24;
const ZOOM = 1.15;

/** @param {() => import("./viewer.js").Viewer} current */
export function wireKeyboard(current) {
  element("canvas").addEventListener("keydown", (event) => {
    const { stage } = current();
    const arrow = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[
      event.key
    ];
    if (arrow !== undefined) {
      (event.shiftKey ? move : turn)(stage, arrow[0], arrow[1]);
    } else if (event.key === "+" || event.key === "=") {
      zoom(stage, 1 / ZOOM);
    } else if (event.key === "-") {
      zoom(stage, ZOOM);
    } else if (event.key === "Home" || event.key === "0") {
      stage.look(LOOKS.home);
    } else {
      return;
    }
    event.preventDefault();
  });
}

/**
 * @param {import("./stage.js").Stage} stage
 * @param {number} right
 * @param {number} up
 */
function turn(stage, right, up) {
  const { camera, controls } = stage;
  const away = camera.position.clone().sub(controls.target);
  const y_up = new Vector3(away.x, away.z, -away.y);
  const place = new Spherical().setFromVector3(y_up);
  place.theta += right * TURN;
  place.phi = Math.min(Math.max(place.phi - up * TURN, 0.02), Math.PI - 0.02);
  const turned = new Vector3().setFromSpherical(place);
  stage.fly(
    controls.target.clone().add(new Vector3(turned.x, -turned.z, turned.y)),
    controls.target.clone(),
    true,
  );
}

/**
 * @param {import("./stage.js").Stage} stage
 * @param {number} right
 * @param {number} up
 */
function move(stage, right, up) {
  const { camera, controls } = stage;
  const step = camera.position.distanceTo(controls.target) / 20;
  const across = new Vector3().setFromMatrixColumn(camera.matrixWorld, 0);
  const upward = new Vector3().setFromMatrixColumn(camera.matrixWorld, 1);
  const moved = across.multiplyScalar(right * step).addScaledVector(upward, up * step);
  stage.fly(camera.position.clone().add(moved), controls.target.clone().add(moved), true);
}

/**
 * @param {import("./stage.js").Stage} stage
 * @param {number} factor
 */
function zoom(stage, factor) {
  const { camera, controls } = stage;
  const away = camera.position.clone().sub(controls.target).multiplyScalar(factor);
  away.clampLength(controls.minDistance, controls.maxDistance);
  stage.fly(controls.target.clone().add(away), controls.target.clone(), true);
}
