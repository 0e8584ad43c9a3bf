// Lint of the studio's page and of its tests, from the root of the project (.ci/page/check).
import js from "@eslint/js";
import globals from "globals";

export default [
  js.configs.recommended,
  {
    files: ["softdot/studio/page/scripts/*.js"],
    languageOptions: { sourceType: "module", globals: { ...globals.browser, uPlot: "readonly" } },
  },
  {
    files: ["tests/studio/*.mjs"],
    languageOptions: { sourceType: "module", globals: globals.node },
  },
  {
    linterOptions: { reportUnusedDisableDirectives: "error" },
    rules: {
      eqeqeq: "error",
      "no-var": "error",
      "prefer-const": ["error", { destructuring: "all" }],
      "no-eval": "error",
      "no-implied-eval": "error",
      "no-new-func": "error",
      "no-shadow": "error",
      "no-param-reassign": "off",
      "no-return-assign": "error",
      "no-self-compare": "error",
      "no-unused-expressions": "error",
      "consistent-return": "error",
      "default-case-last": "error",
      "no-implicit-coercion": "error",
      "no-restricted-properties": [
        "error",
        { property: "innerHTML", message: "Text is set as text." },
        { property: "outerHTML", message: "Text is set as text." },
        { property: "insertAdjacentHTML", message: "Text is set as text." },
      ],
      complexity: ["error", 20],
    },
  },
];
