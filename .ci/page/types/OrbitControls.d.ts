// softdot/studio/page/vendor/OrbitControls.js, which lies beside the scripts once it is served.
export * from "three/examples/jsm/controls/OrbitControls.js";
