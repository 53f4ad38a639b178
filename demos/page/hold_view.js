'use strict';
// The water in the holds of a vessel, and the holds cut out of the surface of the sea. Where a plane lies inside a closed
// surface is found in the stencil: of the surface below the plane, more back faces than front faces are met there.

// Numbers per sample of a hold: volume, a point of the level and its normal; world axes.
const LEVEL_SIZE = 7;

// Draws into the stencil where `plane` is seen inside a closed surface. `place`: the group that moves with the body.
class PlaneInside {
  constructor(geometry, plane, order, place) {
    const draw = (side, operation) => {
      const mesh = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({
        side, clippingPlanes: [plane], depthTest: false, depthWrite: false, colorWrite: false, transparent: true,
        stencilWrite: true, stencilFunc: THREE.AlwaysStencilFunc,
        stencilFail: operation, stencilZFail: operation, stencilZPass: operation,
      }));
      mesh.renderOrder = order;
      place.add(mesh);
      return mesh;
    };
    this.meshes = [draw(THREE.BackSide, THREE.IncrementWrapStencilOp), draw(THREE.FrontSide, THREE.DecrementWrapStencilOp)];
  }
}

class HoldView {
  // `samples`: of the hold's water at the samples of the body's motion; `place`: the group that moves with the body.
  constructor(shape, samples, place) {
    this.samples = samples;
    this.geometry = makeGeometry(shape);
    this.geometry.computeBoundingSphere();
    // One hold after the other, each with its own stencil.
    HoldView.count = (HoldView.count + 1) % 1000;
    const order = HOLD_WATER + HoldView.count / 1000;
    this.level = new THREE.Plane();
    this.sea = new THREE.Plane();
    this.inside = new PlaneInside(this.geometry, this.level, order, place);
    this.inSea = new PlaneInside(this.geometry, this.sea, WATER_MASK, place);
    const span = 2 * this.geometry.boundingSphere.radius;
    this.sheet = new THREE.Mesh(new THREE.PlaneBufferGeometry(span, span), new THREE.MeshLambertMaterial({
      color: 0x2f7fb5, transparent: true, opacity: 0.8, side: THREE.DoubleSide, depthWrite: false,
      stencilWrite: true, stencilRef: 0, stencilFunc: THREE.NotEqualStencilFunc,
    }));
    this.sheet.renderOrder = order + 0.0005;
    this.sheet.onAfterRender = (renderer) => renderer.clearStencil();
    // In world axes, since the level does not turn with the body.
    this.group = new THREE.Group();
    this.group.add(this.sheet);
  }

  // The numbers of a sample, linear between samples.
  waterAt(motion, time) {
    const i = motion.indexBefore(time), j = Math.min(i + 1, motion.count - 1);
    const step = motion.timeOf(j) - motion.timeOf(i);
    const share = step > 0 ? Math.min(Math.max((time - motion.timeOf(i)) / step, 0), 1) : 0;
    return Array.from({ length: LEVEL_SIZE },
      (_, k) => (1 - share) * this.samples[i * LEVEL_SIZE + k] + share * this.samples[j * LEVEL_SIZE + k]);
  }

  // `toView`: leads from the world's axes to the picture's; `seaBelow`: plane of the sea at a place in the picture.
  moveTo(motion, time, toView, seaBelow) {
    const [volume, ...level] = this.waterAt(motion, time);
    const point = new THREE.Vector3().fromArray(level);
    const normal = new THREE.Vector3().fromArray(level, 3).normalize();
    this.volume = volume;
    const centre = this.geometry.boundingSphere.center.clone().applyQuaternion(motion.orientation).add(motion.position);
    this.sheet.visible = this.volume > 0;
    for (const mesh of this.inside.meshes) mesh.visible = this.sheet.visible;
    this.sheet.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), normal);
    this.sheet.position.copy(centre).addScaledVector(normal, normal.dot(point) - normal.dot(centre));
    // Kept is the side into which the normal of a clipping plane points.
    this.level.setFromNormalAndCoplanarPoint(normal.clone().applyQuaternion(toView).negate(), point.applyQuaternion(toView));
    for (const mesh of this.inSea.meshes) mesh.visible = Boolean(seaBelow);
    if (seaBelow) this.sea.copy(seaBelow(centre.applyQuaternion(toView)));
  }
}
HoldView.count = 0;
