int KingpinOptimisationIsEmpty() { return 0; }
