"""The notebook runs from nothing to its figure."""

from __future__ import annotations

import os
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

ROOT = Path(__file__).parents[2]
NOTEBOOKS = sorted((ROOT / "python" / "notebooks").glob("*.ipynb"))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_and_draws(path: Path, tmp_path: Path) -> None:
    notebook = nbformat.read(path, as_version=4)
    # Outputs are not kept in the repository.
    assert not any(cell.get("outputs") or cell.get("execution_count") for cell in notebook.cells)
    folder = tmp_path / "python" / "notebooks"
    folder.mkdir(parents=True)
    os.symlink(ROOT / "experiments", tmp_path / "experiments")
    NotebookClient(
        notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(folder)}}
    ).execute()
    texts = [output.get("text", "") for cell in notebook.cells for output in cell.get("outputs", [])]
    deviation = next(text for text in texts if text.startswith("largest deviation: "))
    # Of forty means that hang together, at 500 cells.
    assert float(deviation.split()[2]) < 3.5
    assert (folder / "first_figure.png").stat().st_size > 20_000
    kept = os.environ.get("PSEUDOPOD_KEEP_FIGURE")
    if kept:
        (folder / "first_figure.png").replace(kept)
