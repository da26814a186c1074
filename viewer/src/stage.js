// Renderer, camera, light, sky and ground: what is there besides the bodies.
import * as THREE from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';
import {ground} from './materials.js';

const kThemes = {
  dark: {top: 0x10151b, horizon: 0x323a45, ground: 0x484f59, line: 0xc3cfdc, strength: 0.17, sky: 0xeaf1fb,
         bounce: 0x757a82, ambient: 1.75, sun: 2.3},
  light: {top: 0x9fbfe0, horizon: 0xe6ecf2, ground: 0xdde3ea, line: 0x62748a, strength: 0.34, sky: 0xffffff,
          bounce: 0xb9bcc2, ambient: 1.8, sun: 2.1},
};
/// From the best picture to the cheapest; `auto` walks down when frames take too long.
export const kQualities = [
  {pixels: 2, shadows: 2048, detail: 1, rich: true},
  {pixels: 1, shadows: 2048, detail: 1, rich: true},
  {pixels: 1, shadows: 1024, detail: 0.6},
  {pixels: 0.75, shadows: 0, detail: 0.28},
  {pixels: 0.5, shadows: 0, detail: 0.2},
];
const kShadowBodies = 3000;

/// Fog and background are final screen colours, so the sky writes them unconverted.
const screenColor = (hex) => new THREE.Vector3((hex >> 16) & 255, (hex >> 8) & 255, hex & 255).divideScalar(255);

function makeSky() {
  const material = new THREE.ShaderMaterial({
    side: THREE.BackSide, depthWrite: false, fog: false,
    uniforms: {top: {value: new THREE.Vector3()}, horizon: {value: new THREE.Vector3()}},
    // At the far plane and drawn last: only where nothing else is.
    vertexShader: `varying vec3 vColor; uniform vec3 top; uniform vec3 horizon;
      void main() {
        float height = clamp(position.y, 0.0, 1.0);
        vColor = mix(horizon, top, 1.0 - pow(1.0 - height, 2.6));
        gl_Position = (projectionMatrix * vec4(mat3(viewMatrix) * position, 1.0)).xyww;
      }`,
    fragmentShader: `varying vec3 vColor;
      void main() {
        float grain = fract(52.98 * fract(dot(gl_FragCoord.xy, vec2(0.0671, 0.0058))));
        gl_FragColor = vec4(vColor + (grain - 0.5) / 255.0, 1.0);
      }`,
  });
  const sky = new THREE.Mesh(new THREE.SphereGeometry(1, 24, 40), material);
  sky.frustumCulled = false;
  sky.renderOrder = 3;
  return sky;
}

/// Without a GPU every pixel counts: no multisampling, and `auto` begins further down.
function drawsInSoftware() {
  const context = document.createElement('canvas').getContext('webgl2');
  const named = context?.getExtension('WEBGL_debug_renderer_info');
  const name = named ? context.getParameter(named.UNMASKED_RENDERER_WEBGL) : '';
  context?.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

export class Stage {
  constructor(canvas, recording, box) {
    this.software = drawsInSoftware();
    this.renderer =
        new THREE.WebGLRenderer({canvas, antialias: !this.software, powerPreference: 'high-performance'});
    this.renderer.toneMapping = THREE.NeutralToneMapping;
    this.renderer.toneMappingExposure = 1.14;
    this.renderer.shadowMap.type = THREE.PCFShadowMap;
    this.renderer.shadowMap.autoUpdate = false;
    this.scene = new THREE.Scene();
    // Everything recorded hangs in here, so that outside it y is up.
    this.world = new THREE.Group();
    this.world.quaternion.setFromUnitVectors(new THREE.Vector3(...recording.up).normalize(), new THREE.Vector3(0, 1, 0));
    this.worldUp = new THREE.Vector3(...recording.up).normalize();
    this.scene.add(this.world);
    this.camera = new THREE.PerspectiveCamera(42, 1, 0.01, 1000);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.12;
    this.controls.zoomToCursor = true;
    this.bodyCount = recording.solidBodies + recording.softs.length;
    this.addLights();
    this.sky = makeSky();
    this.scene.add(this.sky);
    this.scene.fog = new THREE.Fog(0, 1, 2);
    this.frameBox(box);
    this.addPlanes(recording);
    this.resetView();
  }

  addLights() {
    this.ambient = new THREE.HemisphereLight();
    this.sun = new THREE.DirectionalLight(0xfff3e2);
    this.sun.castShadow = true;
    this.scene.add(this.ambient, this.sun, this.sun.target);
  }

  /// Sets the scale of all that depends on the scene's size.
  frameBox(box) {
    this.center = box.getCenter(new THREE.Vector3());
    this.extent = box.getSize(new THREE.Vector3());
    this.radius = Math.max(0.5 * this.extent.length(), 1e-3);
    const {sun, center, radius} = this;
    // From above and behind the first view's left shoulder.
    this.broadside = this.extent.x >= this.extent.z;
    const from = this.broadside ? new THREE.Vector3(-0.45, 1, 0.72) : new THREE.Vector3(0.72, 1, 0.45);
    sun.target.position.copy(center);
    sun.position.copy(center).addScaledVector(from.normalize(), 4 * radius);
    const reach = 1.5 * radius;
    Object.assign(sun.shadow.camera, {left: -reach, right: reach, top: reach, bottom: -reach, near: 0.5 * radius,
                                      far: 8 * radius});
    sun.shadow.camera.updateProjectionMatrix();
    sun.shadow.radius = 2.2;
    sun.shadow.bias = -0.0004;
    sun.shadow.normalBias = reach / 700;
    this.controls.minDistance = 0.01 * radius;
    this.controls.maxDistance = 30 * radius;
    this.cell = 10 ** Math.floor(Math.log10(0.6 * radius));
  }

  addPlanes(recording) {
    this.planes = [];
    for (const shape of recording.shapes) {
      if (shape.kind !== 'plane') continue;
      const size = 1400 * this.radius;
      const mesh = new THREE.Mesh(new THREE.PlaneGeometry(size, size).rotateX(-Math.PI / 2), ground());
      mesh.material.userData.uniforms.cell.value = this.cell;
      mesh.receiveShadow = true;
      mesh.frustumCulled = false;
      mesh.renderOrder = 2;  // after the bodies, so that what they hide is not shaded
      this.planes.push({shape, mesh});
      this.world.add(mesh);
    }
  }

  placePlanes(poses) {
    const body = new THREE.Matrix4(), local = new THREE.Matrix4(), one = new THREE.Vector3(1, 1, 1);
    for (const {shape, mesh} of this.planes) {
      const k = 7 * shape.body;
      body.compose(new THREE.Vector3().fromArray(poses, k), new THREE.Quaternion().fromArray(poses, k + 3), one);
      const turn = new THREE.Quaternion(...shape.rotation).normalize();
      local.compose(new THREE.Vector3(...shape.position), turn, one);
      body.multiply(local).decompose(mesh.position, mesh.quaternion, mesh.scale);
    }
  }

  setTheme(light) {
    const theme = light ? kThemes.light : kThemes.dark;
    this.sky.material.uniforms.top.value.copy(screenColor(theme.top));
    this.sky.material.uniforms.horizon.value.copy(screenColor(theme.horizon));
    this.scene.fog.color.setHex(theme.horizon);
    this.ambient.color.setHex(theme.sky);
    this.ambient.groundColor.setHex(theme.bounce);
    this.ambient.intensity = theme.ambient;
    this.sun.intensity = theme.sun;
    for (const {mesh} of this.planes) {
      mesh.material.color.setHex(theme.ground);
      mesh.material.userData.uniforms.lineColor.value.setHex(theme.line);
      mesh.material.userData.uniforms.lineStrength.value = theme.strength;
    }
  }

  setQuality(level) {
    const {pixels, shadows} = kQualities[level];
    this.quality = level;
    // Where nothing smooths edges otherwise, the best quality draws four pixels for one.
    const ratio = this.software && level === 0 ? 2 : Math.min(window.devicePixelRatio * Math.min(pixels, 1), pixels);
    this.renderer.setPixelRatio(ratio);
    this.sun.castShadow = shadows > 0 && this.bodyCount <= kShadowBodies;
    if (shadows > 0 && this.sun.shadow.mapSize.x !== shadows) {
      this.sun.shadow.mapSize.set(shadows, shadows);
      this.sun.shadow.map?.dispose();
      this.sun.shadow.map = null;
    }
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.needsUpdate = true;
    if (this.width) this.resize(this.width, this.height);
  }

  /// Where `auto` begins.
  firstQuality() {
    if (!this.software) return 0;
    return this.bodyCount > 500 ? 3 : 2;
  }

  resize(width, height) {
    this.width = width;
    this.height = height;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / Math.max(height, 1);
    this.camera.updateProjectionMatrix();
  }

  /// Looks at the scene from its broad side, a little from above.
  resetView() {
    const {extent, center, camera, controls} = this;
    const along = this.broadside ? new THREE.Vector3(0.5, 0.36, 1) : new THREE.Vector3(1, 0.36, -0.5);
    const half = Math.tan((camera.fov * Math.PI) / 360);
    const wide = Math.hypot(extent.x, extent.z) * 0.5, aspect = this.width ? this.width / this.height : 1.6;
    const distance = 1.12 * Math.max(0.5 * extent.y / half, wide / (half * aspect)) + 0.3 * this.radius;
    controls.target.copy(center);
    camera.position.copy(center).addScaledVector(along.normalize(), distance + 0.3 * Math.min(extent.x, extent.z));
    controls.update();
  }

  lookAt(point, radius) {
    const away = this.camera.position.clone().sub(this.controls.target).normalize();
    this.controls.target.copy(point);
    this.camera.position.copy(point).addScaledVector(away, 7 * radius);
    this.controls.update();
  }

  render(posesChanged) {
    const {camera, controls, radius} = this;
    const distance = Math.max(camera.position.distanceTo(controls.target), 0.2 * radius);
    const reach = camera.position.distanceTo(this.center) + radius;
    this.scene.fog.near = 1.3 * reach;
    this.scene.fog.far = 9 * reach;
    camera.near = 0.01 * distance;
    camera.far = 1000 * radius;
    camera.updateProjectionMatrix();
    if (posesChanged) this.renderer.shadowMap.needsUpdate = true;
    this.renderer.render(this.scene, camera);
  }

  /// A point of the recording in pixels of the canvas; z beyond 1 or below -1 is out of sight.
  project(x, y, z, out = new THREE.Vector3()) {
    out.set(x, y, z).applyMatrix4(this.world.matrixWorld).project(this.camera);
    out.x = (0.5 + 0.5 * out.x) * this.width;
    out.y = (0.5 - 0.5 * out.y) * this.height;
    return out;
  }

  /// The ray under a pixel, in the recording's frame.
  rayAt(x, y) {
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2((2 * x) / this.width - 1, 1 - (2 * y) / this.height), this.camera);
    return ray.ray.applyMatrix4(this.world.matrixWorld.clone().invert());
  }
}
