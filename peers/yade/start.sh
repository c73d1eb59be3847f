# Yade prints lines of its own where answers are expected: those go to the errors, and answers through the descriptor 5.
export PYTHONPATH="$1/.." PYTHONDONTWRITEBYTECODE=1
exec 5>&1
exec unshare -rn yade -n -x -j1 "$1/adapter.py" 5>&5 >&2
