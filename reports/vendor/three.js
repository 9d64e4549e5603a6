// The part of three.js that the page of a run uses; `npm run build` makes three.min.js of it.
export {
  AmbientLight, Box3, BoxGeometry, BufferGeometry, CapsuleGeometry, Color, CylinderGeometry, DirectionalLight,
  Float32BufferAttribute, GridHelper, Group, Line, LineBasicMaterial, LineSegments, Mesh, MeshLambertMaterial,
  PerspectiveCamera, Quaternion, Scene, Sphere, SphereGeometry, Vector3, WebGLRenderer,
} from "three";
export { OrbitControls } from "three/addons/controls/OrbitControls.js";
export { SVGRenderer } from "three/addons/renderers/SVGRenderer.js";
