// softdot/studio/page/vendor/three.module.min.js, which lies beside the scripts once it is served.
export * from "three";
