// The structs and constants of tessera_c*.h as a 32-bit program has them, read from the headers themselves.
//   node layout.mjs INCLUDE-FOLDER OUTPUT    writes src/layout.js
import { readFileSync, readdirSync, realpathSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

const scalars = {
  size_t: ['getUint32', 4], int32_t: ['getInt32', 4], uint32_t: ['getUint32', 4], int64_t: ['getBigInt64', 8],
  uint64_t: ['getBigUint64', 8], float: ['getFloat32', 4], double: ['getFloat64', 8], uint8_t: ['getUint8', 1],
};

/** The members that a declaration makes, as [type, name, count]; pointers and functions count as size_t. */
function membersOf(declaration) {
  const [, type, declarators] = /^(?:const\s+|volatile\s+)*(\w+)\s*(.*)$/s.exec(declaration.trim());
  if (/^\(\*/.test(declarators)) return [['size_t', /\(\*(\w+)\)/.exec(declarators)[1], 1]];
  return declarators.split(',').map((each) => {
    const [, star, name, count] = /^\s*(\**)\s*(\w+)(?:\[(\d+)\])?$/.exec(each);
    return [star ? 'size_t' : type, name, Number(count ?? 1)];
  });
}

/** The constants of enums that a text declares: name -> value. */
function constantsOf(text) {
  const constants = {};
  for (const [, body] of text.matchAll(/enum \{([^}]*)\}/g)) {
    let next = 0;
    for (const [, name, value] of body.matchAll(/(TSR_\w+)\s*(?:=\s*(\d+))?/g)) {
      constants[name] = value === undefined ? next : Number(value);
      next = constants[name] + 1;
    }
  }
  return constants;
}

/**
 * Reads all of them: { structs: name -> { size, align, members: name -> { offset, read, bytes, count, struct } },
 * constants: name -> value }. `struct` is the name of a member's own struct.
 */
export function layoutOf(include) {
  const structs = {}, constants = {};
  for (const header of readdirSync(include).filter((name) => /^tessera_c.*\.h$/.test(name)).sort()) {
    const text = readFileSync(join(include, header), 'utf8').replace(/\/\*[\s\S]*?\*\//g, '');
    Object.assign(constants, constantsOf(text));
    for (const [, body, name] of text.matchAll(/typedef struct \w+ \{([\s\S]*?)\} (\w+);/g)) {
      const struct = { size: 0, align: 1, members: {} };
      const declarations = body.split(';').filter((each) => each.trim());
      for (const [type, member, count] of declarations.flatMap(membersOf)) {
        const inner = structs[type];
        const [read, bytes] = inner ? [null, inner.size] : scalars[type];
        const align = inner ? inner.align : bytes;
        const offset = Math.ceil(struct.size / align) * align;
        struct.members[member] = { offset, read, bytes, count, struct: inner ? type : undefined };
        struct.size = offset + bytes * count;
        struct.align = Math.max(struct.align, align);
      }
      struct.size = Math.ceil(struct.size / struct.align) * struct.align;
      structs[name] = struct;
    }
  }
  return { structs, constants };
}

if (process.argv[1] && realpathSync(process.argv[1]) === fileURLToPath(import.meta.url)) {
  const [include, output] = process.argv.slice(2);
  if (!output) {
    console.error('usage: node layout.mjs INCLUDE-FOLDER OUTPUT');
    process.exit(2);
  }
  const layout = JSON.stringify(layoutOf(include));
  writeFileSync(output, `// Made of tessera_c*.h by layout.mjs.\nexport const layout = ${layout};\n`);
}
