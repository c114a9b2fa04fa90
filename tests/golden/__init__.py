"""Plans as they were recorded: of every mission in ``specs`` and of drawn ones, sampled as text."""
