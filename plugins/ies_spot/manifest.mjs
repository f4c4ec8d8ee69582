// A transform of the AssemblyScript compiler: writes iesspot.json into the module as the section that the host reads.
import { readFileSync } from "node:fs";

export default class {
  afterCompile(module) {
    module.addCustomSection("bidir.manifest", readFileSync(new URL("iesspot.json", import.meta.url)));
  }
}
