// The part of three.js that the page of a run uses; `npm run build` makes three.min.js of it.
export {
  AmbientLight, Box3, BoxGeometry, BufferGeometry, CapsuleGeometry, Color, CylinderGeometry, DirectionalLight,
  GridHelper, Group, LessDepth, Line, LineBasicMaterial, LineSegments, Matrix4, Mesh, MeshLambertMaterial, PerspectiveCamera,
  Scene, Sphere, SphereGeometry, Vector3, WebGLRenderer,
} from "three";
export { OrbitControls } from "three/addons/controls/OrbitControls.js";
export { SVGRenderer } from "three/addons/renderers/SVGRenderer.js";
