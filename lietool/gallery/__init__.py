"""A page of all plates for a reader: formulas, prose, HTML, Markdown, and the folder that they go into.

It is handed what it shows (`entry.Entry`) and knows neither figures nor how pictures are made.
"""
