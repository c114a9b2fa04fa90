"""Plans many missions, each as `shotc plan` does; a batch that was stopped resumes where it stopped."""
