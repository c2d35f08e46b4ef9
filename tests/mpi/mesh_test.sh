#!/usr/bin/env bash
# tessera_mpi tessellate on several ranks: the mesh of tessera byte for byte, or an error of all and no file.
#   mesh_test.sh MPIEXEC TESSERA TESSERA_MPI MODELS
# shellcheck source=scratch.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/scratch.sh"

# on RANKS ARGUMENTS...: the program must succeed.
on() {
  local ranks=$1
  shift
  timeout 120 "$mpiexec" -n "$ranks" "$tessera_mpi" tessellate "$@" >report 2>errors ||
    fail "$ranks ranks, $*: $(cat report errors)"
}
# fails_on RANKS ARGUMENTS...: the program (or what `program` names) must fail in time and leave nothing.
fails_on() {
  local ranks=$1 status=0
  shift
  timeout 60 "$mpiexec" -n "$ranks" "${program:-$tessera_mpi}" tessellate "$@" >report 2>errors || status=$?
  ((status != 0)) || fail "$*: it has not failed"
  ((status != 124)) || fail "$*: it hangs: $(cat report errors)"
  [[ -z $(find . -name 'failed*') ]] || fail "$*: the failed program has left $(find . -name 'failed*')"
}

# One file: patches that ranks read run by run, whole models, loops, quads, doubles; more ranks than patches.
meshes() {
  "$tessera" tessellate "$@" -o one.ply >/dev/null 2>&1
  for ranks in 1 2 3 4 7; do
    on $ranks "$@" -o many.ply
    cmp one.ply many.ply || fail "$ranks ranks, $*: not the mesh of one process"
  done
}
meshes "$models/teapot.bpt" --relative 1e-3
meshes "$models/teapot.bpt" --relative 1e-4 --quads --angle 10
meshes "$models/goblet.json" --tolerance 1e-3 --precision double
meshes "$models/trimmed_crossing_cylinders.json" --tolerance 1e-3
grep -q 'triangles, within 0.[0-9]* of the surfaces, proven, by 7 ranks$' report || fail "the report is $(cat report)"
meshes "$models/sphere.json" --grid 5x3
grep -q 'triangles, by 7 ranks$' report || fail "the report of a grid is $(cat report)"

# A CAD file: its instances as one mesh, the same for any number of ranks.
if [[ -n ${TESSERA_TEST_DATA:-} ]] && part=$(find "$TESSERA_TEST_DATA" -name 'as1-oc-214.stp') && [[ -n $part ]] &&
  "$tessera" info "$part" >/dev/null 2>&1; then
  on 1 "$part" --relative 1e-3 -o one.ply
  for ranks in 2 5; do
    on $ranks "$part" --relative 1e-3 -o many.ply
    cmp one.ply many.ply || fail "$ranks ranks: another mesh of $part"
  done
fi

# A piece for each rank, with an index.
on 3 "$models/teapot.bpt" --relative 1e-3 -o pieces.pvtp
[[ $(grep -c '<Piece Source="pieces_000[0-2].vtp"' pieces.pvtp) == 3 ]] || fail "the index is $(cat pieces.pvtp)"
for piece in 0 1 2; do
  [[ -s pieces_000$piece.vtp ]] || fail "piece $piece is missing"
done

# Ranks of different instruction sets: the mesh is made, with a warning. All of one have the mesh of that set.
cat >mixed <<TEXT
#!$BASH
[[ \${OMPI_COMM_WORLD_RANK:-\$PMI_RANK} != 1 ]] || export TESSERA_ISA=sse2
exec "$tessera_mpi" "\$@"
TEXT
chmod +x mixed
timeout 60 "$mpiexec" -n 3 ./mixed tessellate "$models/teapot.bpt" --relative 1e-3 -o mixed.ply >report 2>errors ||
  fail "ranks of two instruction sets: $(cat errors)"
if [[ $("$tessera" info "$models/teapot.bpt" | grep 'instruction set') == *avx2,* ]]; then
  [[ $(grep -c 'warning: .*TESSERA_ISA' errors) == 1 ]] || fail "two instruction sets and no warning: $(cat errors)"
fi
TESSERA_ISA=sse2 "$tessera" tessellate "$models/teapot.bpt" --relative 1e-3 -o one.ply >/dev/null
TESSERA_ISA=sse2 on 2 "$models/teapot.bpt" --relative 1e-3 -o many.ply
cmp one.ply many.ply || fail "sse2: not the mesh of one process"
[[ ! -s errors ]] || fail "one instruction set and a warning: $(cat errors)"

# Failures: of all, of one rank, of the disk, of the command line.
fails_on 3 missing.bpt -o failed.ply
[[ $(grep -c missing.bpt errors) == 1 ]] || fail "an error of all ranks is said once: $(cat errors)"
head -c 900 "$models/teapot.bpt" >cut.bpt
fails_on 3 cut.bpt -o failed.ply
grep -q 'cut.bpt:[0-9]' errors || fail "the error names no line: $(cat errors)"
fails_on 2 "$models/teapot.bpt" --tolerance 1e-12 -o failed.ply
grep -q 'part [01]: ' errors || fail "the error names no part: $(cat errors)"
fails_on 2 "$models/teapot.bpt" --relative 1e-3 --fewest -o failed.ply
fails_on 2 "$models/teapot.bpt" --relative 1e-3 -o failed.stl
# A disk that is full for the ranks, not for mpiexec, whose own files would be refused first (it then fails or hangs).
# 8 MB are enough for the memory that ranks share: the .ply is 30 MB; one piece of the .pvtp fits, two do not.
cat >small_disk <<TEXT
#!$BASH
ulimit -f 8192
exec "$tessera_mpi" "\$@"
TEXT
chmod +x small_disk
for output in failed.ply failed.pvtp; do
  program=./small_disk fails_on 3 "$models/teapot.bpt" --relative 1e-5 -o $output
  grep -q "part [0-9]: failed.*\(set_size\|too large\)" errors || fail "$output: the error names no file: $(cat errors)"
done
status=0
timeout 60 "$mpiexec" -n 2 "$tessera_mpi" tessellate "$models/teapot.bpt" -o failed.ply : \
  -n 1 "$tessera_mpi" tessellate missing.bpt -o failed.ply >report 2>errors || status=$?
((status != 0)) && [[ -z $(find . -name 'failed*') ]] || fail "one rank failed: $status, $(find . -name 'failed*')"
grep -q 'part 2: missing.bpt' errors || fail "the message of the rank that failed: $(cat errors)"
