#!/usr/bin/env python3
"""Opens the rows of a study with pyarrow, pandas and polars, and holds their shares against those of the program.

Usage: open_rows.py DIR/rows.parquet SUMMARY.json     SUMMARY.json is what `toile study --json` printed
Needs: pip install pandas polars pyarrow
"""

import json
import sys

import pandas
import polars
import pyarrow.parquet


def fitted(rows, garment):
    """Share of people whom the size recommended to them fits."""
    people = rows[(rows.garment == garment) & rows.offered & (rows["size"] == rows.best_size) & (rows.pose == "standing")]
    offered = rows[(rows.garment == garment) & rows.offered].drop_duplicates("person")
    return (people.fits * people.weight).sum() / offered.weight.sum()


def main(path, summary):
    with open(summary, encoding="utf-8") as file:
        said = json.load(file)
    notes = {key.decode(): value.decode() for key, value in pyarrow.parquet.read_schema(path).metadata.items()}
    assert notes["toile.schema"] == "toile.study/1", notes
    assert notes["toile.study_sha256"] == said["summary"]["study_sha256"]
    by_pandas, by_polars = pandas.read_parquet(path), polars.read_parquet(path)
    assert len(by_pandas) == len(by_polars) == said["merged"]["rows"] == int(notes["toile.rows"])
    assert list(by_pandas.columns) == by_polars.columns
    assert list(by_pandas.row) == list(range(len(by_pandas)))
    for garment in said["summary"]["garments"]:
        name, share = garment["name"], garment["fitted"]["share"]
        tried = {note["name"]: note for note in json.loads(notes["toile.garments"])}[name]
        if len(tried["tried"]) < len(tried["sizes"]):
            continue  # Who is recommended a size that is not tried has no row of it.
        one = fitted(by_pandas, name)
        two = by_polars.filter(
            (polars.col("garment") == name) & polars.col("offered") & (polars.col("size") == polars.col("best_size"))
        )
        two = (two["fits"].cast(float) * two["weight"]).sum() / two["weight"].sum()
        assert abs(one - share) < 1e-9 and abs(two - share) < 1e-9, (name, one, two, share)
        print(f"{name}: {100 * one:.1f} % fitted, by pandas {pandas.__version__} and polars {polars.__version__} as by toile")


if __name__ == "__main__":
    main(*sys.argv[1:])
