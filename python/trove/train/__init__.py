"""Measures what a dataset is worth: the paper's experiment, on anyone's images.

`python -m trove.train EXPERIMENT.toml --out DIR` trains one network for every row of the paper's table and every seed,
and writes the table. It needs the optional extra: `pip install 'trove-scenes[train]'`.
"""
