"""The page: one offline HTML file that shows a part or a model, with its figures and findings."""
