# taichi prints a banner where answers are expected: that goes to the errors, and answers through the descriptor 5.
python="$1/venv/bin/python"
[ -x "$python" ] || python=python3
if [ "$2" = --version ]; then
    exec "$python" -c "from importlib.metadata import version; print('taichi', version('taichi'))"
fi
export PYTHONPATH="$1/.." PYTHONDONTWRITEBYTECODE=1
exec 5>&1
exec "$python" "$1/adapter.py" 5>&5 >&2
