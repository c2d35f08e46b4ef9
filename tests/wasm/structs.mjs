// The structs of tessera_c*.h as a 32-bit program lays them out, read from the headers themselves.
import { readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';

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

/** Reads all structs: name -> { size, align, members: name -> { offset, read, bytes, count, struct } }. */
export function structsOf(include) {
  const structs = {};
  for (const header of readdirSync(include).filter((name) => /^tessera_c.*\.h$/.test(name)).sort()) {
    const text = readFileSync(join(include, header), 'utf8').replace(/\/\*[\s\S]*?\*\//g, '');
    for (const [, body, name] of text.matchAll(/typedef struct \w+ \{([\s\S]*?)\} (\w+);/g)) {
      const struct = { size: 0, align: 1, members: {} };
      const declarations = body.split(';').filter((each) => each.trim());
      for (const [type, member, count] of declarations.flatMap(membersOf)) {
        const inner = structs[type];
        const [read, bytes] = inner ? [null, inner.size] : scalars[type];
        const align = inner ? inner.align : bytes;
        const offset = Math.ceil(struct.size / align) * align;
        struct.members[member] = { offset, read, bytes, count, struct: inner };
        struct.size = offset + bytes * count;
        struct.align = Math.max(struct.align, align);
      }
      struct.size = Math.ceil(struct.size / struct.align) * struct.align;
      structs[name] = struct;
    }
  }
  return structs;
}
