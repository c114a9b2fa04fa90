"""Many missions, each planned as `shotc plan` plans one; a batch that is stopped goes on from there."""
