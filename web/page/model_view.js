// The 3-D view: parts, the hull of a moment, its contact points, and each touch as a ball to click on.
import {
  AmbientLight, Box3, BufferAttribute, BufferGeometry, DirectionalLight, DoubleSide, GridHelper, Group, Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial,
  PerspectiveCamera, Points, PointsMaterial, Raycaster, Scene, SphereGeometry, Vector2, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { geometryOf } from './meshes.js';
import { makeSwitches } from './model_switches.js';

const PART_COLOURS = [0x8ca1b8, 0xb8ad8c, 0x94b399, 0xa899b8, 0xb39e99, 0x8cb0b5];
const FLIGHT_MS = 450;

// Null where the browser has no WebGL.
function makeRenderer() {
  try {
    return new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  } catch {
    return null;
  }
}

// Three.js tells the console when there is no WebGL; so it is asked for first.
function hasWebGl() {
  try {
    return document.createElement('canvas').getContext('webgl2') !== null;
  } catch {
    return false;
  }
}

function matrixOf(pose) {
  return new Matrix4().set(...pose, 0, 0, 0, 1);
}

export function makeModelView(place, model, touches, onTouch) {
  const renderer = hasWebGl() ? makeRenderer() : null;
  if (!renderer) return null;
  const scene = new Scene();
  const camera = new PerspectiveCamera(35, 1, 1, 1e6);
  camera.up.set(0, 0, 1);
  const geometries = model.meshes.map(geometryOf);
  const material = (color, opacity = 1) => new MeshLambertMaterial({ color, flatShading: true, side: DoubleSide, transparent: opacity < 1, opacity, depthWrite: opacity === 1 });

  const parts = model.parts.map((part, i) => {
    const mesh = new Mesh(geometries[part.mesh], material(PART_COLOURS[i % PART_COLOURS.length], 0.72));
    mesh.matrixAutoUpdate = false;
    return mesh;
  });
  const volumes = model.volumes.map(({ mesh }) => new Mesh(geometries[mesh], material(0x2a7f78, 0.35)));
  const hulls = new Map();
  const hull = new Group();
  const points = new Points(new BufferGeometry(), new PointsMaterial({ color: 0xd0201a, size: 6, sizeAttenuation: false, depthTest: false }));
  points.frustumCulled = false;
  const balls = new Group();
  scene.add(new AmbientLight(0xffffff, 1.6), ...parts, ...volumes, hull, points, balls);
  const lamp = new DirectionalLight(0xffffff, 2.2);
  camera.add(lamp);
  lamp.position.set(0.4, 0.8, 1);
  scene.add(camera);

  pose(model.moments[0]);
  const extent = new Box3();
  for (const mesh of parts) extent.expandByObject(mesh);
  if (extent.isEmpty()) extent.set(new Vector3(...model.low), new Vector3(...model.high));
  const size = extent.getSize(new Vector3()).length();
  addGrid();
  touches.forEach((touch, i) => {
    if (!touch.at) return;
    const ball = new Mesh(new SphereGeometry(size / 160, 16, 12), new MeshBasicMaterial({ color: touch.kind === 'touch' ? 0xc2311f : 0xb7791f, depthTest: false, transparent: true, opacity: 0.85 }));
    ball.renderOrder = 2;
    ball.position.set(...touch.at);
    ball.userData.touch = i;
    balls.add(ball);
  });

  renderer.domElement.setAttribute('aria-label', 'Parts, hull and touches in space; drag to turn, wheel to come nearer');
  renderer.domElement.tabIndex = 0;
  const told = document.createElement('p');
  told.className = 'told';
  const canvasPlace = place.querySelector('.model-place');
  canvasPlace.replaceChildren(renderer.domElement);
  canvasPlace.after(told);
  const controls = new OrbitControls(camera, renderer.domElement);
  controls.enableDamping = false;
  controls.listenToKeyEvents(renderer.domElement);
  controls.addEventListener('change', draw);
  makeSwitches(told, [
    ...model.parts.map(({ name }, i) => ({ name, shown: true, set: (on) => { parts[i].visible = on; } })),
    ...model.volumes.map(({ name }, i) => ({ name, shown: true, set: (on) => { volumes[i].visible = on; } })),
    { name: 'hull of what is real', shown: true, set: (on) => { hull.visible = on; } },
    { name: 'contact points', shown: true, set: (on) => { points.visible = on; } },
    { name: 'all touches', shown: true, set: (on) => { balls.visible = on; } },
  ], draw);
  new ResizeObserver(fit).observe(canvasPlace);
  const dark = window.matchMedia('(prefers-color-scheme: dark)');
  dark.addEventListener('change', draw);
  lookFrom(extent.getCenter(new Vector3()), new Vector3(-0.55, -1, 0.62), 1.5 * size);
  pickTouches();
  fit();

  function addGrid() {
    const side = 2 ** Math.ceil(Math.log2(1.5 * size));
    const grid = new GridHelper(side, 16, 0x999999, 0xbbbbbb);
    grid.rotation.x = Math.PI / 2;
    const centre = extent.getCenter(new Vector3());
    grid.position.set(centre.x, centre.y, model.low[2]);
    scene.add(grid);
  }

  function pose(moment) {
    if (!moment) return;
    moment.poses.forEach((numbers, i) => {
      parts[i].matrix.copy(matrixOf(numbers));
      parts[i].matrixWorldNeedsUpdate = true;
    });
  }

  function draw() {
    scene.background = null;
    renderer.setClearColor(dark.matches ? 0x1c232b : 0xeef1f4);
    renderer.render(scene, camera);
  }

  function fit() {
    const { clientWidth: width, clientHeight: height } = canvasPlace;
    if (width === 0 || height === 0) return;
    renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    draw();
  }

  function lookFrom(target, direction, distance) {
    controls.target.copy(target);
    camera.position.copy(target).addScaledVector(direction.clone().normalize(), distance);
    camera.near = size / 1000;
    camera.far = 50 * size;
    camera.updateProjectionMatrix();
    controls.update();
  }

  function flyTo(target, distance) {
    const from = controls.target.clone();
    const direction = camera.position.clone().sub(from);
    const fromDistance = direction.length();
    const begin = performance.now();
    const lasts = window.matchMedia('(prefers-reduced-motion: reduce)').matches ? 0 : FLIGHT_MS;
    (function step() {
      const t = lasts === 0 ? 1 : Math.min((performance.now() - begin) / lasts, 1);
      const s = t * t * (3 - 2 * t);
      lookFrom(from.clone().lerp(target, s), direction, fromDistance + (distance - fromDistance) * s);
      draw();
      place.dataset.flying = String(t < 1);
      if (t < 1) requestAnimationFrame(step);
    })();
  }

  function showHull(index) {
    hull.clear();
    if (index === null || index === undefined) return;
    if (!hulls.has(index)) hulls.set(index, new Mesh(geometries[index], material(0xdeab8c)));
    hull.add(hulls.get(index));
  }

  function show(index) {
    const touch = touches[index];
    if (!touch) return;
    const moment = model.moments[touch.moment];
    pose(moment);
    showHull(moment ? moment.hull : null);
    points.geometry.dispose();
    points.geometry = new BufferGeometry();
    points.geometry.setAttribute('position', new BufferAttribute(new Float32Array(moment ? moment.points.flat() : []), 3));
    for (const ball of balls.children) ball.scale.setScalar(ball.userData.touch === index ? 1.8 : 1);
    told.textContent = touch.told + (moment && moment.hull !== null ? '' : ' The hull of this moment is not in this page.');
    place.dataset.selected = String(index);
    place.dataset.points = String(moment ? moment.points.length : 0);
    if (touch.at) flyTo(new Vector3(...touch.at), 0.8 * size);
    draw();
  }

  function pickTouches() {
    let pressed = null;
    renderer.domElement.addEventListener('pointerdown', (event) => { pressed = [event.clientX, event.clientY]; });
    renderer.domElement.addEventListener('pointerup', (event) => {
      if (!pressed || !balls.visible || Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) > 4) return;
      const box = renderer.domElement.getBoundingClientRect();
      const caster = new Raycaster();
      caster.setFromCamera(new Vector2(2 * (event.clientX - box.left) / box.width - 1, 1 - 2 * (event.clientY - box.top) / box.height), camera);
      const [hit] = caster.intersectObjects(balls.children);
      if (hit) onTouch(hit.object.userData.touch);
    });
  }

  // Where a touch's ball is on the screen, in CSS pixels; for tests.
  place.positionOfTouch = (index) => {
    const at = new Vector3(...touches[index].at).project(camera);
    const box = renderer.domElement.getBoundingClientRect();
    return [box.left + (at.x + 1) / 2 * box.width, box.top + (1 - at.y) / 2 * box.height];
  };
  return { show };
}
