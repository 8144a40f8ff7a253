# printprep with everything a batch needs, for one machine or as scheduler and workers of a cluster.
#
#   docker build -t printprep .
#   docker run --rm -v "$PWD:/data" printprep printprep batch models -o parts
FROM python:3.12-slim-bookworm

# MeshLab's filters and MuJoCo load the system's OpenGL; PrusaSlicer weighs prints with infill
RUN apt-get update \
 && apt-get install -y --no-install-recommends libgl1 libegl1 libopengl0 libgomp1 prusa-slicer \
 && rm -rf /var/lib/apt/lists/*

WORKDIR /opt/printprep
COPY pyproject.toml README.md LICENSE ./
COPY printprep printprep
COPY profiles profiles
# The CPU build of PyTorch is gigabytes smaller than the usual one
RUN pip install --no-cache-dir torch==2.13.0+cpu --extra-index-url https://download.pytorch.org/whl/cpu \
 && pip install --no-cache-dir '.[cluster]'

# One thread a library in each process: a worker runs one model at a time, and there is one a core.
# The last two put glibc's limits back, which Dask lowers: see docs/cluster.md
ENV OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 \
    DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES=2 \
    MALLOC_TRIM_THRESHOLD_=67108864 MALLOC_MMAP_THRESHOLD_=33554432
WORKDIR /data
CMD ["printprep", "--help"]
