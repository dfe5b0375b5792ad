// Unpacks the Chromium of the npm package @sparticuz/chromium in FOLDER/node_modules to FOLDER/chromium; the libraries
// that a plain server lacks come to FOLDER/lib, and a typeface beside them.
import { execFileSync } from "node:child_process";
import { chmodSync, readFileSync, renameSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { brotliDecompressSync } from "node:zlib";

const folder = process.argv[2];
const packed = (name) => brotliDecompressSync(readFileSync(join(folder, "node_modules/@sparticuz/chromium/bin", name)));

for (const name of ["al2023.tar", "swiftshader.tar", "fonts.tar"]) {
  const tar = join(folder, name);
  writeFileSync(tar, packed(`${name}.br`));
  execFileSync("tar", ["-xf", tar, "-C", folder]);
  rmSync(tar);
}
// Under its name only once it is whole.
const part = join(folder, "chromium.part");
writeFileSync(part, packed("chromium.br"));
chmodSync(part, 0o755);
renameSync(part, join(folder, "chromium"));
