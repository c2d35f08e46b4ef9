#!/usr/bin/env bash
# tessera_mpi on several ranks: the files of tessera byte for byte, or an error of all and no file.
#   program_test.sh MPIEXEC TESSERA TESSERA_MPI MODELS
# shellcheck source=scratch.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/scratch.sh"

# on RANKS ARGUMENTS...: the program must succeed.
on() {
  local ranks=$1
  shift
  timeout 60 "$mpiexec" -n "$ranks" "$tessera_mpi" "$@" >report 2>errors || fail "$ranks ranks, $*: $(cat report errors)"
}
same() {
  cmp "$1" "$2" || fail "$1 is not $2: $(cat report errors)"
}
# ends_without FILE STATUS: the last program must have failed and left nothing.
ends_without() {
  ((status != 0)) || fail "$1: the program has not failed: $(cat errors)"
  [[ -z $(find . -name "$1*") ]] || fail "$1: the failed program has left $(find . -name "$1*")"
}

readelf -d "$tessera" | grep -q 'NEEDED.*libmpi' && fail "the command line tessera loads MPI"
readelf -d "$tessera_mpi" | grep -q 'NEEDED.*libmpi' || fail "tessera_mpi does not load MPI"

# Pictures: 19 bands, so that ranks take turns; the last band is lower.
picture=(raycast "$models/goblet.json" --size 200x149 --quality draft)
"$tessera" "${picture[@]}" -o one.png >/dev/null
for ranks in 1 2 3 4; do
  on $ranks "${picture[@]}" -o many.png
  same many.png one.png
  [[ $(wc -l <report) == 1 && ! -s errors ]] || fail "$ranks ranks report: $(cat report errors)"
done
"$tessera" "${picture[@]}" -o one.exr >/dev/null
on 3 "${picture[@]}" -o many.exr
same many.exr one.exr
on 4 "${picture[@]}" -o many.exr --data-parallel
same many.exr one.exr

# Hits of 3000 rays at a model of 32 patches.
awk 'BEGIN { srand(7); print "ox,oy,oz,dx,dy,dz"
  for (k = 0; k < 3000; ++k) printf "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", 6 * rand() - 3, 6 * rand() - 3, 8,
    rand() - 0.5, rand() - 0.5, -4 }' >rays.csv
hits=(raycast "$models/teapot.bpt" --rays rays.csv)
"$tessera" "${hits[@]}" --hits one.csv >/dev/null
for ranks in 2 4; do
  on $ranks "${hits[@]}" --hits many.csv --data-parallel
  same many.csv one.csv
done
on 3 "${hits[@]}" --hits many.csv
same many.csv one.csv
(($(grep -c ',1,' one.csv) > 100)) || fail "hardly a ray hits the model"

# Points, as rows and as JSON.
for format in csv json; do
  points=(eval "$models/goblet.json" "$models/sphere.json" --grid 9x7 --derivs 2 --format "$format")
  "$tessera" "${points[@]}" -o "one.$format" >/dev/null
  on 3 "${points[@]}" -o "many.$format"
  same "many.$format" "one.$format"
done

# A rank that fails. The last one alone has another model, which is missing.
status=0
timeout 60 "$mpiexec" -n 2 "$tessera_mpi" "${picture[@]}" -o failed.png : \
  -n 1 "$tessera_mpi" raycast missing.json --size 200x149 -o failed.png >report 2>errors || status=$?
ends_without failed.png
grep -q 'tessera_mpi: part 2: missing.json' errors || fail "the message of the rank that failed: $(cat errors)"
status=0
timeout 60 "$mpiexec" -n 3 "$tessera_mpi" raycast missing.json -o failed.png >report 2>errors || status=$?
ends_without failed.png
[[ $(grep -c missing.json errors) == 1 ]] || fail "an error of all ranks is said once: $(cat errors)"
status=0
timeout 60 "$mpiexec" -n 2 "$tessera_mpi" "${picture[@]}" -o "$place/no/../folder" --mode exact --data-parallel \
  >report 2>errors || status=$?
((status == 2)) || fail "a wrong command line ends with $status: $(cat errors)"

# A rank that is killed.
cat >ranked <<TEXT
#!$BASH
echo \$\$ >"rank.\${OMPI_COMM_WORLD_RANK:-\$PMI_RANK}"
exec "$tessera_mpi" "\$@"
TEXT
chmod +x ranked
status=0
timeout 60 "$mpiexec" -n 3 ./ranked raycast "$models/goblet.json" --size 2000x2000 -o killed.png >report 2>errors &
mpirun=$!
for ((k = 0; k < 200; ++k)); do
  [[ -s rank.1 && -n $(find . -name 'killed.png*') ]] && break
  sleep 0.05
done
kill -9 "$(cat rank.1)"
wait "$mpirun" || status=$?
ends_without killed.png
((status != 124)) || fail "the other ranks hang after one was killed"
