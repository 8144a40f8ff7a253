import js from "@eslint/js";
import globals from "globals";

export default [
  js.configs.recommended,
  { files: ["src/**/*.js"], languageOptions: { globals: globals.browser } },
  { files: ["*.js"], languageOptions: { globals: globals.node } },
  { rules: { eqeqeq: "error", "prefer-const": "error", "no-var": "error", curly: "error" } },
];
