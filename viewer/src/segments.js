// Thick lines and round dots whose number changes from frame to frame.
import * as THREE from 'three';
import {LineMaterial} from 'three/addons/lines/LineMaterial.js';
import {LineSegments2} from 'three/addons/lines/LineSegments2.js';
import {LineSegmentsGeometry} from 'three/addons/lines/LineSegmentsGeometry.js';

export class Segments {
  constructor(color, width, order) {
    this.material =
        new LineMaterial({color, linewidth: width, transparent: true, opacity: 0.95, depthTest: false, fog: false});
    this.capacity = 0;
    this.object = new LineSegments2(new LineSegmentsGeometry(), this.material);
    this.object.frustumCulled = false;
    this.object.renderOrder = order;
    this.set([], 0);
  }

  /// 6 numbers a segment.
  set(points, count) {
    if (count > this.capacity || this.capacity === 0) {
      this.capacity = Math.max(64, 2 * count);
      this.object.geometry.dispose();
      this.object.geometry = new LineSegmentsGeometry().setPositions(new Float32Array(6 * this.capacity));
    }
    const {data} = this.object.geometry.attributes.instanceStart;
    data.array.set(points.length > 6 * count ? points.subarray(0, 6 * count) : points);
    data.needsUpdate = true;
    this.object.geometry.instanceCount = count;
    this.object.visible = count > 0;
  }
}

export class Dots {
  constructor(color, size, order) {
    this.material = new THREE.ShaderMaterial({
      transparent: true, depthTest: false, depthWrite: false,
      uniforms: {color: {value: new THREE.Color(color)}, size: {value: size}, ratio: {value: 1}},
      vertexShader: `uniform float size, ratio;
        void main() {
          gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
          gl_PointSize = size * ratio;
        }`,
      fragmentShader: `uniform vec3 color; uniform float size, ratio;
        void main() {
          float away = length(gl_PointCoord - 0.5) * size * ratio;
          float edge = 0.5 * size * ratio;
          vec3 shade = mix(color, vec3(0.02), smoothstep(edge - 2.2 * ratio, edge - 1.2 * ratio, away) * 0.75);
          gl_FragColor = vec4(shade, 1.0 - smoothstep(edge - ratio, edge, away));
          #include <colorspace_fragment>
        }`,
    });
    this.object = new THREE.Points(new THREE.BufferGeometry(), this.material);
    this.object.frustumCulled = false;
    this.object.renderOrder = order;
    this.capacity = 0;
    this.set([], 0);
  }

  /// 3 numbers a dot.
  set(points, count) {
    if (count > this.capacity || this.capacity === 0) {
      this.capacity = Math.max(64, 2 * count);
      this.object.geometry.dispose();
      this.object.geometry = new THREE.BufferGeometry();
      this.object.geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(3 * this.capacity), 3));
    }
    const {position} = this.object.geometry.attributes;
    position.array.set(points.length > 3 * count ? points.subarray(0, 3 * count) : points);
    position.needsUpdate = true;
    this.object.geometry.setDrawRange(0, count);
    this.object.visible = count > 0;
  }
}
