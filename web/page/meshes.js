// Meshes as the page holds them: corners quantised within their box, both lists in base64.
import { BufferAttribute, BufferGeometry } from 'three';

function bytesOf(base64) {
  return Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0)).buffer;
}

// {low, step: three numbers in mm; vertices: 16-bit triples; triangles: 16-bit, or 32-bit where `wide`}
export function geometryOf({ low, step, vertices, triangles, wide }) {
  const steps = new Uint16Array(bytesOf(vertices));
  const positions = new Float32Array(steps.length);
  for (let i = 0; i < steps.length; ++i) positions[i] = low[i % 3] + step[i % 3] * steps[i];
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  geometry.setIndex(new BufferAttribute(wide ? new Uint32Array(bytesOf(triangles)) : new Uint16Array(bytesOf(triangles)), 1));
  return geometry;
}
