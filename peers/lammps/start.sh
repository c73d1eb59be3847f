# LAMMPS prints where answers are expected: that goes to the errors, and answers through the descriptor 5.
python="$1/venv/bin/python"
[ -x "$python" ] || python=python3
# The MPI that its wheel asks for lies beside the other packages, where the loader does not look.
export LD_LIBRARY_PATH="$1/venv/lib:$LD_LIBRARY_PATH" OMP_NUM_THREADS="${OMP_NUM_THREADS:-1}"
if [ "$2" = --version ]; then
    exec "$python" -c "from importlib.metadata import version; print('LAMMPS', version('lammps'))"
fi
# It would listen on all interfaces for other processes of the run: there are none.
export UCX_TLS=self
export PYTHONPATH="$1/.." PYTHONDONTWRITEBYTECODE=1
exec 5>&1
exec "$python" "$1/adapter.py" 5>&5 >&2
