trap '' HUP INT QUIT TERM
groups=' '
while read -r what group; do
  case $what in
    +) groups="$groups$group " ;;
    -) groups="${groups%% $group *} ${groups#* $group }" ;;
  esac
done
for group in $groups; do kill -s KILL -- "-$group"; done
for look in 1 2 3; do
  for file in $(grep -lsF "$1" /proc/[0-9]*/environ); do
    number=${file#/proc/}
    kill -s KILL "${number%/environ}"
  done
done
